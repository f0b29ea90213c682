#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstring>

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
