#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstring>

#include "absl/time/clock.h"
#include "core/base/sha256.h"
#include "core/motion/io/clip_file.h"
#include "proto/convert/status_convert.h"
#include "server/handlers/artifact_handler.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_clips.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::TestServer;

// Numbers counted up: no two chunks are equal.
std::string DistinctBytes(size_t size) {
  std::string bytes(size, '\0');
  for (uint32_t i = 0; i < size / sizeof(i); ++i) std::memcpy(&bytes[i * sizeof(i)], &i, sizeof(i));
  return bytes;
}

StatusOr<v1::Artifact> Upload(const TestServer& server, const std::string& bytes,
                              const std::string& sha256 = "",
                              size_t chunk_bytes = ArtifactHandler::kChunkBytes) {
  const auto stub = v1::ArtifactService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::Artifact artifact;
  const auto writer = stub->Upload(&context, &artifact);
  for (size_t begin = 0; begin < bytes.size(); begin += chunk_bytes) {
    v1::UploadRequest request;
    request.set_chunk(bytes.substr(begin, chunk_bytes));
    if (begin + chunk_bytes >= bytes.size()) request.set_sha256(sha256);
    if (!writer->Write(request)) break;
  }
  writer->WritesDone();
  const grpc::Status status = writer->Finish();
  if (!status.ok()) return convert::FromGrpc(status);
  return artifact;
}

StatusOr<std::string> Download(const TestServer& server, const std::string& name, int64_t offset) {
  const auto stub = v1::ArtifactService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::DownloadRequest request;
  request.set_name(name);
  request.set_offset(offset);
  const auto reader = stub->Download(&context, request);
  std::string bytes;
  v1::DownloadResponse response;
  while (reader->Read(&response)) bytes += response.chunk();
  const grpc::Status status = reader->Finish();
  if (!status.ok()) return convert::FromGrpc(status);
  return bytes;
}

TEST(ArtifactServiceTest, FileLargerThanAMessageGoesUpAndComesDown) {
  TestServer server;
  const std::string bytes = DistinctBytes(100 << 20);
  const StatusOr<v1::Artifact> artifact = Upload(server, bytes);
  ASSERT_TRUE(artifact.ok()) << artifact.status();
  EXPECT_EQ(artifact->size_bytes(), static_cast<int64_t>(bytes.size()));
  EXPECT_EQ(artifact->name().size(), 74u);
  EXPECT_TRUE(*Download(server, artifact->name(), 0) == bytes);
  const int64_t middle = bytes.size() / 2 + 7;
  EXPECT_TRUE(*Download(server, artifact->name(), middle) == bytes.substr(middle));
  EXPECT_EQ(*Download(server, artifact->name(), bytes.size()), "");
  std::printf("100 MiB up in 1 MiB chunks and down again: equal\n");
}

TEST(ArtifactServiceTest, UploadsThatAreWrongAreRefused) {
  TestServer server;
  EXPECT_EQ(base::ErrorReason(Upload(server, "abc", std::string(64, '0')).status()),
            "WRONG_DIGEST");
  EXPECT_EQ(base::ErrorReason(Upload(server, DistinctBytes(3 << 20), "", 2 << 20).status()),
            "CHUNK_TOO_LARGE");
  EXPECT_EQ(base::ErrorReason(Upload(server, "").status()), "EMPTY_UPLOAD");
  const grpc::Status status =
      testing::RawCall(server.channel(), "/poise.v1.ArtifactService/Upload", "\xff\xff");
  EXPECT_EQ(testing::ErrorInfoOf(status).reason(), "MALFORMED_REQUEST");
}

constexpr char kUploadId[] = "0123456789abcdef";

// One stream of an upload with an id: `bytes` from `offset` on, then the digest, or a client that
// goes away.
class UploadPart {
 public:
  UploadPart(const TestServer& server, int64_t offset)
      : stub_(v1::ArtifactService::NewStub(server.channel())),
        writer_(stub_->Upload(&context_, &artifact_)) {
    v1::UploadRequest first;
    first.set_upload_id(kUploadId);
    first.set_offset(offset);
    writer_->Write(first);
  }

  void Send(const std::string& bytes) {
    for (size_t begin = 0; begin < bytes.size(); begin += ArtifactHandler::kChunkBytes) {
      v1::UploadRequest request;
      request.set_chunk(bytes.substr(begin, ArtifactHandler::kChunkBytes));
      if (!writer_->Write(request)) break;
    }
  }
  void Break() {
    context_.TryCancel();
    writer_->Finish();
  }
  StatusOr<v1::Artifact> Finish(const std::string& sha256) {
    v1::UploadRequest last;
    last.set_sha256(sha256);
    writer_->Write(last);
    writer_->WritesDone();
    const grpc::Status status = writer_->Finish();
    if (!status.ok()) return convert::FromGrpc(status);
    return artifact_;
  }

 private:
  grpc::ClientContext context_;
  v1::Artifact artifact_;
  std::unique_ptr<v1::ArtifactService::Stub> stub_;
  std::unique_ptr<grpc::ClientWriter<v1::UploadRequest>> writer_;
};

StatusOr<v1::UnfinishedUpload> GetUpload(const TestServer& server, const std::string& id,
                                         const std::string& sha256 = "") {
  const auto stub = v1::ArtifactService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::GetUploadRequest request;
  request.set_upload_id(id);
  request.set_sha256(sha256);
  v1::UnfinishedUpload upload;
  const grpc::Status status = stub->GetUpload(&context, request, &upload);
  if (!status.ok()) return convert::FromGrpc(status);
  return upload;
}

// Waits until the server has stored this much.
void AwaitBytes(const TestServer& server, int64_t bytes) {
  while (GetUpload(server, kUploadId)->received_bytes() < bytes) {
    absl::SleepFor(absl::Milliseconds(1));
  }
}

TEST(ArtifactServiceTest, AnUploadThatBreaksGoesOnWhereItBroke) {
  TestServer server;
  const std::string bytes = DistinctBytes(5 << 20);
  const std::string digest = base::Sha256Hex(bytes);
  UploadPart first(server, 0);
  first.Send(bytes.substr(0, 2 << 20));
  AwaitBytes(server, 2 << 20);
  first.Break();
  const v1::UnfinishedUpload half = *GetUpload(server, kUploadId, digest);
  EXPECT_EQ(half.received_bytes(), 2 << 20);
  EXPECT_FALSE(half.has_artifact());
  UploadPart second(server, 2 << 20);
  second.Send(bytes.substr(2 << 20));
  const auto artifact = second.Finish(digest);
  ASSERT_TRUE(artifact.ok()) << artifact.status();
  EXPECT_EQ(artifact->size_bytes(), 5 << 20);
  EXPECT_TRUE(*Download(server, artifact->name(), 0) == bytes);
  const v1::UnfinishedUpload whole = *GetUpload(server, kUploadId, digest);
  EXPECT_EQ(whole.received_bytes(), 0);
  EXPECT_EQ(whole.artifact().name(), artifact->name());
}

TEST(ArtifactServiceTest, OfTwoStreamsOnOneUploadTheLaterGoesOn) {
  TestServer server;
  const std::string bytes = DistinctBytes(3 << 20);
  UploadPart first(server, 0);
  first.Send(bytes.substr(0, 1 << 20));
  AwaitBytes(server, 1 << 20);
  UploadPart second(server, 1 << 20);
  second.Send(bytes.substr(1 << 20, 1 << 20));
  AwaitBytes(server, 2 << 20);
  first.Send(DistinctBytes(1 << 20));
  const auto refused = first.Finish(base::Sha256Hex(bytes));
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kAborted);
  EXPECT_EQ(base::ErrorReason(refused.status()), "UPLOAD_TAKEN_OVER");
  second.Send(bytes.substr(2 << 20));
  EXPECT_TRUE(second.Finish(base::Sha256Hex(bytes)).ok());
}

TEST(ArtifactServiceTest, AnUploadWithAnIdEndsOnlyWithItsDigest) {
  TestServer server;
  UploadPart unsure(server, 0);
  unsure.Send("abc");
  EXPECT_EQ(base::ErrorReason(unsure.Finish("").status()), "MISSING_DIGEST");
  EXPECT_EQ(GetUpload(server, kUploadId)->received_bytes(), 3) << "it can still be finished";
  EXPECT_TRUE(UploadPart(server, 3).Finish(base::Sha256Hex("abc")).ok());
  UploadPart wrong(server, 0);
  wrong.Send("abd");
  EXPECT_EQ(base::ErrorReason(wrong.Finish(base::Sha256Hex("abc")).status()), "WRONG_DIGEST");
  EXPECT_EQ(GetUpload(server, kUploadId)->received_bytes(), 0);
}

TEST(ArtifactServiceTest, UploadsThatCannotGoOnAreRefused) {
  TestServer server;
  EXPECT_EQ(base::ErrorReason(UploadPart(server, 1).Finish("").status()), "WRONG_OFFSET");
  EXPECT_EQ(base::ErrorReason(GetUpload(server, "../x").status()), "BAD_UPLOAD_ID");
  EXPECT_EQ(base::ErrorReason(GetUpload(server, kUploadId, "x").status()), "BAD_ARTIFACT_NAME");
  const auto stub = v1::ArtifactService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::Artifact artifact;
  const auto writer = stub->Upload(&context, &artifact);
  v1::UploadRequest request;
  request.set_offset(1);
  writer->WriteLast(request, {});
  EXPECT_EQ(base::ErrorReason(convert::FromGrpc(writer->Finish())), "BAD_UPLOAD_ID");
}

TEST(ArtifactServiceTest, DownloadsThatCannotBeAreRefused) {
  TestServer server;
  const std::string name = Upload(server, "abc")->name();
  EXPECT_EQ(base::ErrorReason(Download(server, "artifacts/../x", 0).status()), "BAD_ARTIFACT_NAME");
  EXPECT_EQ(base::ErrorReason(Download(server, "artifacts/" + std::string(64, 'a'), 0).status()),
            "ARTIFACT_NOT_FOUND");
  EXPECT_EQ(base::ErrorReason(Download(server, name, 4).status()), "BAD_OFFSET");
  EXPECT_EQ(base::ErrorReason(Download(server, name, -1).status()), "BAD_OFFSET");
}

TEST(ArtifactServiceTest, StoredFileIsASourceOfVariants) {
  TestServer server;
  const std::string name = Upload(server, motion::EncodeBvh(testing::SwingingClip(30)))->name();
  v1::AugmentRequest request;
  request.add_sources()->mutable_stored()->set_artifact(name);
  request.mutable_sources(0)->mutable_stored()->set_name("swing.bvh");
  request.set_variants_per_source(3);
  grpc::Status status;
  EXPECT_EQ(testing::ReadVariants(server.channel(), request, &status).size(), 3u);
  EXPECT_TRUE(status.ok()) << status.error_message();
}

}  // namespace
}  // namespace poise::server
