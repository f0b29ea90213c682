#include "client/client.h"

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>

#include <atomic>
#include <thread>

#include "absl/time/clock.h"
#include "poise/v1/artifact_service.grpc.pb.h"
#include "poise/v1/augmentation_service.grpc.pb.h"
#include "proto/convert/augment_convert.h"
#include "tests/support/test_clips.h"

// The client against a server of the test's own, over a real channel.
namespace poise::client {
namespace {

using ::testing::HasSubstr;

// "abc", FIPS 180-2 appendix B.1.
constexpr char kAbcName[] =
    "artifacts/ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

/// Answers with as many variants as were asked for: the first source, renamed.
class EchoAugmentation : public v1::AugmentationService::Service {
 public:
  grpc::Status Augment(grpc::ServerContext* context, const v1::AugmentRequest* request,
                       grpc::ServerWriter<v1::AugmentResponse>* writer) override {
    last_request = *request;
    const auto token = context->client_metadata().find("authorization");
    if (token != context->client_metadata().end()) {
      authorization = std::string(token->second.data(), token->second.size());
    }
    for (int i = 0; i < request->variants_per_source(); ++i) {
      v1::AugmentResponse response;
      response.set_index(i);
      response.mutable_file()->set_name("variant.bvh");
      if (!writer->Write(response)) break;
    }
    while (wait_for_cancel && !context->IsCancelled()) absl::SleepFor(absl::Milliseconds(1));
    saw_cancel = context->IsCancelled();
    return grpc::Status::OK;
  }

  v1::AugmentRequest last_request;
  std::string authorization;
  std::atomic<bool> wait_for_cancel = false;
  std::atomic<bool> saw_cancel = false;
};

/// Keeps one file in memory under the name that the client gave its hash.
class MemoryArtifacts : public v1::ArtifactService::Service {
 public:
  grpc::Status Upload(grpc::ServerContext*, grpc::ServerReader<v1::UploadRequest>* reader,
                      v1::Artifact* artifact) override {
    data.clear();
    v1::UploadRequest request;
    while (reader->Read(&request)) {
      data += request.chunk();
      largest_chunk = std::max(largest_chunk, request.chunk().size());
      artifact->set_name("artifacts/" + request.sha256());
    }
    artifact->set_size_bytes(static_cast<int64_t>(data.size()));
    return grpc::Status::OK;
  }

  grpc::Status GetUpload(grpc::ServerContext*, const v1::GetUploadRequest*,
                         v1::UnfinishedUpload*) override {
    return grpc::Status::OK;
  }

  grpc::Status Download(grpc::ServerContext*, const v1::DownloadRequest* request,
                        grpc::ServerWriter<v1::DownloadResponse>* writer) override {
    for (size_t i = request->offset(); i < data.size(); i += 2) {
      v1::DownloadResponse response;
      response.set_chunk(data.substr(i, 2));
      writer->Write(response);
    }
    return grpc::Status::OK;
  }

  std::string data;
  size_t largest_chunk = 0;
};

class ClientTest : public ::testing::Test {
 protected:
  ClientTest() {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&augmentation_);
    builder.RegisterService(&artifacts_);
    server_ = builder.BuildAndStart();
    options_.server = "127.0.0.1:" + std::to_string(port);
  }

  std::unique_ptr<Client> Connect() {
    StatusOr<std::unique_ptr<Client>> client = Client::Connect(options_);
    EXPECT_TRUE(client.ok()) << client.status();
    return *std::move(client);
  }

  static api::AugmentSpec Spec(int frames) {
    api::AugmentSpec spec;
    spec.sources.push_back({.clip = poise::testing::SwingingClip(frames), .joint_roles = {}});
    spec.variants_per_source = 3;
    return spec;
  }

  EchoAugmentation augmentation_;
  MemoryArtifacts artifacts_;
  std::unique_ptr<grpc::Server> server_;
  ClientOptions options_;
};

TEST_F(ClientTest, AStreamGivesEveryVariantInOrderAndThenTheEnd) {
  options_.token = "secret";
  const auto client = Connect();
  const auto stream = *client->Augment(Spec(5));
  for (int i = 0; i < 3; ++i) {
    const auto variant = stream->Next();
    ASSERT_TRUE(variant.ok()) << variant.status();
    EXPECT_EQ(variant->value().index, i);
  }
  for (int again = 0; again < 2; ++again) {
    const auto end = stream->Next();
    ASSERT_TRUE(end.ok());
    EXPECT_FALSE(end->has_value());
  }
  EXPECT_EQ(augmentation_.authorization, "Bearer secret");
}

TEST_F(ClientTest, CancelReachesTheServerAndEndsTheStream) {
  augmentation_.wait_for_cancel = true;
  const auto client = Connect();
  const auto stream = *client->Augment(Spec(5));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(stream->Next().ok());
  std::thread canceller([&] {
    absl::SleepFor(absl::Milliseconds(20));
    stream->Cancel();
  });
  EXPECT_EQ(stream->Next().status().code(), absl::StatusCode::kCancelled);
  canceller.join();
  server_->Shutdown();
  EXPECT_TRUE(augmentation_.saw_cancel);
}

TEST_F(ClientTest, AnAbandonedStreamIsCancelled) {
  augmentation_.wait_for_cancel = true;
  const auto client = Connect();
  { const auto stream = *client->Augment(Spec(5)); }
  server_->Shutdown();  // would wait for ever for a call that still runs
  SUCCEED();
}

TEST_F(ClientTest, ADeadlineEndsACallThatTakesTooLong) {
  augmentation_.wait_for_cancel = true;
  options_.timeout = absl::Milliseconds(100);
  const auto client = Connect();
  const auto stream = *client->Augment(Spec(5));
  Status status;
  while (status.ok()) status = stream->Next().status();
  EXPECT_EQ(status.code(), absl::StatusCode::kDeadlineExceeded);
}

TEST_F(ClientTest, ASourceAboveTheLimitIsUploadedInChunksAndReadBackTheSame) {
  options_.inline_bytes = 10'000;
  const auto client = Connect();
  const api::AugmentSpec spec = Spec(2000);
  const auto stream = *client->Augment(spec);
  ASSERT_TRUE(stream->Next().ok());
  const v1::ClipSource& sent = augmentation_.last_request.sources(0);
  ASSERT_TRUE(sent.has_stored());
  EXPECT_GT(artifacts_.data.size(), 1u << 20);
  EXPECT_LE(artifacts_.largest_chunk, 1u << 20);
  const auto source = convert::FromProto(augmentation_.last_request);
  ASSERT_TRUE(source.ok()) << source.status();
  const auto& stored = std::get<api::StoredClip>(source->sources[0].clip);
  const auto decoded =
      motion::DecodeClip(stored.name, artifacts_.data, stored.format, stored.hints);
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  const auto& original = std::get<motion::Clip>(spec.sources[0].clip);
  ASSERT_EQ(decoded->clip.num_frames(), original.num_frames());
  EXPECT_LT((decoded->clip.root_position(1999) - original.root_position(1999)).norm(), 1e-5);
  const int sent_knee = *original.skeleton()->Find("left_knee");
  const int stored_knee = *decoded->clip.skeleton()->Find("left_knee");
  EXPECT_LT(
      decoded->clip.rotation(1999, stored_knee).angularDistance(original.rotation(1999, sent_knee)),
      1e-5);
}

TEST_F(ClientTest, SmallSourcesStayInTheRequest) {
  const auto client = Connect();
  const auto stream = *client->Augment(Spec(5));
  ASSERT_TRUE(stream->Next().ok());
  EXPECT_TRUE(augmentation_.last_request.sources(0).has_clip());
}

TEST_F(ClientTest, WhatIsUploadedCanBeDownloadedWholeOrFromAnOffset) {
  const auto client = Connect();
  const auto stored = client->Upload("abc");
  ASSERT_TRUE(stored.ok()) << stored.status();
  EXPECT_EQ(stored->name, kAbcName);
  EXPECT_EQ(stored->size_bytes, 3);
  EXPECT_EQ(*client->Download(stored->name), "abc");
  EXPECT_EQ(*client->Download(stored->name, 2), "c");
}

TEST_F(ClientTest, ADownloadThatDoesNotHashToItsNameIsAnError) {
  const auto client = Connect();
  artifacts_.data = "abd";
  EXPECT_EQ(base::ErrorReason(client->Download(kAbcName).status()), "CORRUPTED");
}

TEST_F(ClientTest, HealthTellsServingFromDraining) {
  const auto client = Connect();
  EXPECT_EQ(*client->Health(), ServerHealth::kServing);
  server_->GetHealthCheckService()->SetServingStatus(false);
  EXPECT_EQ(*client->Health(), ServerHealth::kNotServing);
}

TEST_F(ClientTest, BadSpecsAreRefusedBeforeTheyAreSent) {
  const auto client = Connect();
  EXPECT_EQ(base::ErrorReason(client->Augment({}).status()), "EMPTY_REQUEST");
}

TEST_F(ClientTest, WithoutAServerConnectSaysSoAtOnce) {
  server_->Shutdown();
  server_.reset();
  const absl::Time start = absl::Now();
  const auto client = Client::Connect(options_);
  EXPECT_EQ(base::ErrorReason(client.status()), "NO_SERVER");
  EXPECT_THAT(base::Message(client.status()), HasSubstr("poised --listen " + options_.server));
  EXPECT_LT(absl::Now() - start, absl::Seconds(2));
}

}  // namespace
}  // namespace poise::client
