#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>

#include "absl/time/clock.h"
#include "client/artifact_transfer.h"
#include "client/backoff.h"
#include "core/base/identifier.h"
#include "core/base/sha256.h"

namespace poise::client {
namespace {

// Half of the largest chunk: of a stream that breaks one chunk is lost on its way, and one more was
// about to follow.
constexpr int64_t kChunkBytes = 512 << 10;
constexpr int kIdBytes = 16;

StatusOr<std::string> DigestOf(const UploadSource& source) {
  base::Sha256 digest;
  for (int64_t offset = 0; offset < source.size_bytes;) {
    POISE_ASSIGN_OR_RETURN(const std::string block, source.read(offset, kChunkBytes));
    if (block.empty()) break;
    digest.Update(block);
    offset += static_cast<int64_t>(block.size());
  }
  return digest.HexDigest();
}

/// One file on its way up.
class UploadTask {
 public:
  UploadTask(const Connection& connection, const UploadSource& source, std::string digest)
      : connection_(connection),
        source_(source),
        digest_(std::move(digest)),
        deadline_(absl::Now() + connection.options().timeout),
        backoff_({.outage = connection.options().outage}) {
    if (source.size_bytes > kChunkBytes) id_ = base::RandomHex(kIdBytes);
  }

  StatusOr<StoredArtifact> Run() {
    while (true) {
      const Status status = Attempt();
      if (status.ok()) break;
      POISE_ASSIGN_OR_RETURN(const absl::Duration delay, DelayAfter(status));
      if (absl::Now() + delay >= deadline_) return status;
      connection_.Pause(delay);
    }
    if (!IsNamed(stored_.name(), digest_)) {
      return base::Internal("CORRUPTED", fmt::format("sent a file with SHA-256 {}, stored was '{}'",
                                                     digest_, stored_.name()));
    }
    return StoredArtifact{
        .name = stored_.name(), .size_bytes = stored_.size_bytes(), .sent_bytes = sent_bytes_};
  }

 private:
  StatusOr<absl::Duration> DelayAfter(const Status& status) {
    const std::string reason = base::ErrorReason(status);
    // The server lost power and kept less than it had said, or the disk lies: begin anew, once.
    if (reason == "WRONG_DIGEST" && offset_ > 0 && !began_anew_) {
      began_anew_ = true;
      id_ = base::RandomHex(kIdBytes);
      return absl::ZeroDuration();
    }
    // The stream before was just being finished when this one came.
    const bool ask_again = reason == "WRONG_OFFSET";
    const std::optional<absl::Duration> delay =
        backoff_.Next(ask_again ? absl::UnavailableError("") : status);
    if (!delay) return status;
    return *delay;
  }

  Status Attempt() {
    int64_t begin = 0;
    if (!id_.empty()) {
      v1::GetUploadRequest request;
      request.set_upload_id(id_);
      request.set_sha256(digest_);
      v1::UnfinishedUpload upload;
      const auto context = connection_.NewCall(deadline_ - absl::Now());
      POISE_RETURN_IF_ERROR(
          connection_.Explain(connection_.artifact().GetUpload(context.get(), request, &upload)));
      if (upload.has_artifact()) {
        stored_ = upload.artifact();
        return absl::OkStatus();
      }
      begin = upload.received_bytes();
    }
    if (begin > offset_) backoff_.NoteProgress();
    offset_ = begin;
    return Send();
  }

  Status Send() {
    const auto context = connection_.NewCall(deadline_ - absl::Now());
    const auto writer = connection_.artifact().Upload(context.get(), &stored_);
    bool open = true;  // a server that refuses closes the stream early; Finish says why
    if (!id_.empty()) {
      v1::UploadRequest first;
      first.set_upload_id(id_);
      first.set_offset(offset_);
      open = writer->Write(first);
    }
    for (int64_t at = offset_; open && at < source_.size_bytes;) {
      StatusOr<std::string> chunk = source_.read(at, kChunkBytes);
      if (!chunk.ok() || chunk->empty()) {
        context->TryCancel();
        writer->Finish();
        POISE_RETURN_IF_ERROR(chunk.status());
        return base::InvalidArgument("WRONG_DIGEST", "file", "the file became shorter meanwhile");
      }
      at += static_cast<int64_t>(chunk->size());
      sent_bytes_ += static_cast<int64_t>(chunk->size());
      v1::UploadRequest request;
      request.set_chunk(*std::move(chunk));
      open = writer->Write(request);
    }
    if (open) {
      v1::UploadRequest last;
      last.set_sha256(digest_);
      writer->WriteLast(last, {});
    }
    return connection_.Explain(writer->Finish());
  }

  const Connection& connection_;
  const UploadSource& source_;
  const std::string digest_;
  const absl::Time deadline_;
  Backoff backoff_;
  std::string id_;  // empty: so short that it is sent again as a whole
  int64_t offset_ = 0;
  int64_t sent_bytes_ = 0;
  bool began_anew_ = false;
  v1::Artifact stored_;
};

}  // namespace

UploadSource MemorySource(std::string_view data) {
  return {.size_bytes = static_cast<int64_t>(data.size()),
          .read = [data](int64_t offset, int64_t max_bytes) -> StatusOr<std::string> {
            return std::string(data.substr(offset, max_bytes));
          }};
}

StatusOr<UploadSource> FileSource(const std::filesystem::path& path) {
  const auto stream = std::make_shared<std::ifstream>(path, std::ios::binary);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (!*stream || error) {
    return base::NotFound("FILE_NOT_FOUND", "",
                          fmt::format("{}: no such file, or it cannot be read", path.string()));
  }
  return UploadSource{
      .size_bytes = static_cast<int64_t>(size),
      .read = [stream, path](int64_t offset, int64_t max_bytes) -> StatusOr<std::string> {
        std::string bytes(max_bytes, '\0');
        stream->clear();
        stream->seekg(offset);
        stream->read(bytes.data(), max_bytes);
        if (stream->bad()) {
          return base::MakeError(absl::StatusCode::kDataLoss, "CANNOT_READ", "",
                                 fmt::format("{}: cannot be read", path.string()));
        }
        bytes.resize(stream->gcount());
        return bytes;
      }};
}

StatusOr<StoredArtifact> Upload(const Connection& connection, const UploadSource& source) {
  POISE_ASSIGN_OR_RETURN(std::string digest, DigestOf(source));
  return UploadTask(connection, source, std::move(digest)).Run();
}

}  // namespace poise::client
