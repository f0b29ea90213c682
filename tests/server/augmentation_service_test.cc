#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "proto/convert/augment_convert.h"
#include "proto/convert/status_convert.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_clips.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::ReadVariants;
using testing::SwingRequest;
using testing::TestServer;

constexpr char kAugment[] = "/poise.v1.AugmentationService/Augment";

Status Convert(const grpc::Status& status) { return convert::FromGrpc(status); }

TEST(AugmentationServiceTest, StreamsEveryVariantInOrder) {
  TestServer server;
  v1::AugmentRequest request = SwingRequest(60, 7);
  *request.add_sources() = request.sources(0);
  grpc::Status status;
  const std::vector<std::string> variants = ReadVariants(server.channel(), request, &status);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(variants.size(), 14u);
  for (int i = 0; i < 14; ++i) {
    v1::AugmentResponse response;
    ASSERT_TRUE(response.ParseFromString(variants[i]));
    EXPECT_EQ(response.source_index(), i / 7);
    EXPECT_EQ(response.index(), i % 7);
    const auto variant = convert::FromProto(response);
    ASSERT_TRUE(variant.ok()) << variant.status();
    EXPECT_TRUE(variant->ik.has_value());
    EXPECT_TRUE(variant->plausibility.has_value());
  }
}

TEST(AugmentationServiceTest, SameSeedGivesTheSameBytesOnAnyNumberOfThreadsAndConnections) {
  const v1::AugmentRequest request = SwingRequest(90, 20, 7);
  grpc::Status status;
  TestServer one_thread({}, 1), four_threads({}, 4);
  const std::vector<std::string> expected = ReadVariants(one_thread.channel(), request, &status);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(expected.size(), 20u);
  EXPECT_EQ(ReadVariants(four_threads.channel(), request, &status), expected);

  std::vector<std::vector<std::string>> over_connection(5);
  std::vector<std::thread> clients;
  for (auto& variants : over_connection) {
    clients.emplace_back([&] {
      grpc::Status ignored;
      variants = ReadVariants(four_threads.NewChannel(), request, &ignored);
    });
  }
  for (std::thread& client : clients) client.join();
  for (const auto& variants : over_connection) EXPECT_EQ(variants, expected);
  EXPECT_NE(ReadVariants(one_thread.channel(), SwingRequest(90, 20, 8), &status), expected);
  size_t bytes = 0;
  for (const std::string& variant : expected) bytes += variant.size();
  std::printf("20 variants, %zu bytes: equal on 1 and 4 threads, over 1 and 5 connections\n",
              bytes);
}

TEST(AugmentationServiceTest, BvhAnswersKeepTheUnitAndChannelsOfTheirSource) {
  motion::SourceConvention metres;
  metres.unit_m = 1.0;
  TestServer server;
  v1::AugmentRequest request = SwingRequest(30, 1);
  const std::string bvh = motion::EncodeBvh(testing::SwingingClip(30), metres);
  request.mutable_sources(0)->mutable_file()->set_name("swing.bvh");
  request.mutable_sources(0)->mutable_file()->set_data(bvh);
  request.set_output(v1::OUTPUT_ENCODING_BVH);
  request.set_method("mirror");
  grpc::Status status;
  const auto variants = ReadVariants(server.channel(), request, &status);
  ASSERT_TRUE(status.ok()) << status.error_message();
  v1::AugmentResponse response;
  ASSERT_TRUE(response.ParseFromString(variants.at(0)));
  EXPECT_EQ(response.file().format(), v1::CLIP_FORMAT_BVH);
  const std::string& answer = response.file().data();
  const auto hierarchy = [](const std::string& text) {
    return text.substr(0, text.find("MOTION"));
  };
  EXPECT_EQ(hierarchy(answer), hierarchy(bvh));
}

TEST(AugmentationServiceTest, EveryErrorNamesItsReasonAndField) {
  TestServer server;
  using Request = v1::AugmentRequest;
  const std::vector<std::tuple<std::string, std::string, void (*)(Request&)>> cases = {
      {"EMPTY_REQUEST", "sources", [](Request& r) { r.clear_sources(); }},
      {"EMPTY_SOURCE", "sources[0].source", [](Request& r) { r.mutable_sources(0)->clear_clip(); }},
      {"WRONG_SHAPE", "sources[0].clip.rotations",
       [](Request& r) { r.mutable_sources(0)->mutable_clip()->add_rotations(0); }},
      {"BAD_FRAME_RATE", "sources[0].clip.frame_rate",
       [](Request& r) { r.mutable_sources(0)->mutable_clip()->set_frame_rate(-5); }},
      {"UNKNOWN_METHOD", "method", [](Request& r) { r.set_method("magic"); }},
      {"UNKNOWN_ACTION_CLASS", "action_class", [](Request& r) { r.set_action_class("swim"); }},
      {"UNKNOWN_PRESET", "preset", [](Request& r) { r.set_preset("best"); }},
      {"BAD_VARIANT_COUNT", "variants_per_source",
       [](Request& r) { r.set_variants_per_source(-3); }},
      {"UNKNOWN_CONFIG_KEY", "ik.radius_lo",
       [](Request& r) { (*r.mutable_overrides())["ik.radius_lo"] = "1"; }},
      {"UNKNOWN_ROLE", "sources[0].joint_roles",
       [](Request& r) { (*r.mutable_sources(0)->mutable_joint_roles())["tail"] = "pelvis"; }},
      {"UNKNOWN_FORMAT", "sources[0].file.data",
       [](Request& r) { r.mutable_sources(0)->mutable_file()->set_data("nonsense"); }},
      {"ARTIFACT_NOT_FOUND", "sources[0].stored.artifact",
       [](Request& r) {
         r.mutable_sources(0)->mutable_stored()->set_artifact("artifacts/" + std::string(64, '0'));
       }},
      {"BAD_ARTIFACT_NAME", "sources[0].stored.artifact",
       [](Request& r) {
         r.mutable_sources(0)->mutable_stored()->set_artifact("../../etc/passwd");
       }},
  };
  for (const auto& [reason, field, change] : cases) {
    v1::AugmentRequest request = SwingRequest(20, 2);
    change(request);
    grpc::Status status;
    ReadVariants(server.channel(), request, &status);
    EXPECT_EQ(testing::ErrorInfoOf(status).domain(), "poise.dev");
    EXPECT_EQ(base::ErrorReason(Convert(status)), reason) << status.error_message();
    EXPECT_NE(base::ErrorField(Convert(status)).find(field), std::string::npos)
        << reason << ": " << base::ErrorField(Convert(status));
  }
}

TEST(AugmentationServiceTest, BytesThatAreNoMessageAndUnknownMethodsHaveDetailsToo) {
  TestServer server;
  grpc::Status status = testing::RawCall(server.channel(), kAugment, "\xff\xff\xff\xff");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(testing::ErrorInfoOf(status).reason(), "MALFORMED_REQUEST");
  status = testing::RawCall(server.channel(), "/poise.v1.AugmentationService/Divine", "");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNIMPLEMENTED);
  EXPECT_EQ(testing::ErrorInfoOf(status).reason(), "UNKNOWN_METHOD");
}

TEST(AugmentationServiceTest, MoreFramesThanTheLimitAreRefusedBeforeAnyWork) {
  TestServer server;
  grpc::Status status;
  v1::AugmentRequest request = SwingRequest(3000, 1'000'000);
  EXPECT_TRUE(ReadVariants(server.channel(), request, &status).empty());
  EXPECT_EQ(base::ErrorReason(Convert(status)), "REQUEST_TOO_LARGE");
}

TEST(AugmentationServiceTest, DeadlineOfTheClientStopsTheStream) {
  TestServer server;
  const auto stub = v1::AugmentationService::NewStub(server.channel());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(300));
  const auto reader = stub->Augment(&context, SwingRequest(360, 100'000));
  v1::AugmentResponse response;
  int variants = 0;
  while (reader->Read(&response)) ++variants;
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_LT(variants, 100'000);
}

TEST(AugmentationServiceTest, MethodsOwnDeadlineEndsReadersAndStalledReadersAlike) {
  ServerConfig config;
  config.methods.augment = {.default_deadline = absl::Milliseconds(300),
                            .max_deadline = absl::Milliseconds(300)};
  TestServer server(config);
  for (const bool stalled : {false, true}) {
    const auto stub = v1::AugmentationService::NewStub(server.channel());
    grpc::ClientContext context;
    const auto reader = stub->Augment(&context, SwingRequest(3600, 500'000));
    v1::AugmentResponse response;
    if (stalled) std::this_thread::sleep_for(std::chrono::milliseconds(600));
    while (reader->Read(&response)) {
    }
    const grpc::Status status = reader->Finish();
    if (stalled) {
      // Nothing can be sent past the unread data: the stream is cut.
      EXPECT_FALSE(status.ok());
    } else {
      EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED) << status.error_message();
      EXPECT_EQ(testing::ErrorInfoOf(status).reason(), "DEADLINE_EXCEEDED");
    }
  }
}

TEST(AugmentationServiceTest, RequestIdComesBackAndIsMadeWhereAbsent) {
  TestServer server;
  const auto stub = v1::AugmentationService::NewStub(server.channel());
  const auto id_for = [&](const std::string& sent) {
    grpc::ClientContext context;
    if (!sent.empty()) context.AddMetadata("x-request-id", sent);
    const auto reader = stub->Augment(&context, SwingRequest(20, 1));
    v1::AugmentResponse response;
    while (reader->Read(&response)) {
    }
    EXPECT_TRUE(reader->Finish().ok());
    const auto found = context.GetServerInitialMetadata().find("x-request-id");
    return found == context.GetServerInitialMetadata().end()
               ? std::string()
               : std::string(found->second.data(), found->second.size());
  };
  EXPECT_EQ(id_for("night-42"), "night-42");
  EXPECT_EQ(id_for("").size(), 16u);
  EXPECT_EQ(id_for(std::string(500, 'x')).size(), 16u);
}

}  // namespace
}  // namespace poise::server
