#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "absl/time/clock.h"
#include "client/artifact_transfer.h"
#include "client/backoff.h"
#include "core/base/sha256.h"

namespace poise::client {
namespace {

namespace fs = std::filesystem;

constexpr char kNamePrefix[] = "artifacts/";
constexpr size_t kBlockBytes = 1 << 20;

Status CannotWrite(const fs::path& path) {
  return base::FailedPrecondition(
      "CANNOT_WRITE", "out",
      fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

// Adds the bytes of a file to the digest; returns how many, 0 when there is none.
int64_t Digest(const fs::path& file, base::Sha256& digest) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> block(kBlockBytes);
  int64_t size = 0;
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())),
         stream.gcount() > 0) {
    digest.Update({block.data(), static_cast<size_t>(stream.gcount())});
    size += stream.gcount();
  }
  return size;
}

Status CompletePart(const Connection& connection, const std::string& name, const fs::path& part) {
  base::Sha256 digest;
  const int64_t have = Digest(part, digest);
  errno = 0;
  std::ofstream stream(part, std::ios::binary | std::ios::app);
  POISE_RETURN_IF_ERROR(Download(connection, name, have, [&](std::string_view bytes) -> Status {
    digest.Update(bytes);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return stream ? absl::OkStatus() : CannotWrite(part);
  }));
  stream.close();
  if (!stream) return CannotWrite(part);
  if (IsNamed(name, digest.HexDigest())) return absl::OkStatus();
  return base::Internal("CORRUPTED",
                        fmt::format("what came for '{}' does not hash to its name", name));
}

}  // namespace

bool IsNamed(const std::string& artifact, const std::string& sha256) {
  return artifact == kNamePrefix + sha256;
}

Status Download(const Connection& connection, const std::string& name, int64_t offset,
                const std::function<Status(std::string_view)>& sink) {
  const absl::Time deadline = absl::Now() + connection.options().timeout;
  Backoff backoff({.outage = connection.options().outage});
  while (true) {
    const auto context = connection.NewCall(deadline - absl::Now());
    v1::DownloadRequest request;
    request.set_name(name);
    request.set_offset(offset);
    const auto reader = connection.artifact().Download(context.get(), request);
    v1::DownloadResponse response;
    Status status;
    while (status.ok() && reader->Read(&response)) {
      offset += static_cast<int64_t>(response.chunk().size());
      backoff.NoteProgress();
      status = sink(response.chunk());
    }
    if (!status.ok()) context->TryCancel();
    const Status call = connection.Explain(reader->Finish());
    POISE_RETURN_IF_ERROR(status);
    if (call.ok()) return call;
    const std::optional<absl::Duration> delay = backoff.Next(call);
    if (!delay || absl::Now() + *delay >= deadline) return call;
    connection.Pause(*delay);
  }
}

Status DownloadToFile(const Connection& connection, const std::string& name, const fs::path& path) {
  base::Sha256 present;
  Digest(path, present);
  if (IsNamed(name, present.HexDigest()) && fs::exists(path)) return absl::OkStatus();
  const fs::path part = path.string() + ".part";
  Status status = CompletePart(connection, name, part);
  const std::string reason = base::ErrorReason(status);
  if (reason == "CORRUPTED" || reason == "BAD_OFFSET") {
    // What was left there may be of something else: begin anew, once.
    std::error_code ignored;
    fs::remove(part, ignored);
    status = CompletePart(connection, name, part);
    if (base::ErrorReason(status) == "CORRUPTED") fs::remove(part, ignored);
  }
  POISE_RETURN_IF_ERROR(status);
  std::error_code error;
  fs::rename(part, path, error);
  if (!error) return absl::OkStatus();
  errno = error.value();
  return CannotWrite(path);
}

}  // namespace poise::client
