#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>

#include "core/artifacts/model_artifact.h"
#include "core/prediction/mixer/mixer_config.h"
#include "core/prediction/network_body.h"
#include "core/prediction/training/training_config.h"
#include "poise/v1/prediction_service.grpc.pb.h"
#include "proto/convert/clip_convert.h"
#include "proto/convert/predict_convert.h"
#include "proto/convert/status_convert.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_clips.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::SwingingClip;
using testing::TestServer;

v1::PredictRequest Request(const std::string& model = "zero-velocity") {
  return convert::ToProto(
      api::PredictQuery{.source = {SwingingClip(60), {}}, .model = model, .horizon_s = 0.25});
}

grpc::Status Predict(TestServer& server, const v1::PredictRequest& request,
                     v1::PredictResponse* response) {
  grpc::ClientContext context;
  return v1::PredictionService::NewStub(server.channel())->Predict(&context, request, response);
}

TEST(PredictionServiceTest, HoldsTheLastPoseForAsManyFramesAsFitInTheHorizon) {
  TestServer server;
  v1::PredictResponse response;
  const grpc::Status status = Predict(server, Request(), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.model(), "zero-velocity");
  EXPECT_EQ(response.version(), "1");
  EXPECT_TRUE(response.deterministic());
  EXPECT_FALSE(response.inpainted());
  ASSERT_EQ(response.frame_times_s_size(), 30);
  EXPECT_DOUBLE_EQ(response.frame_times_s(0), 1 / 120.0);
  EXPECT_DOUBLE_EQ(response.frame_times_s(29), 0.25);
  const auto forecast = convert::FromProto(response);
  ASSERT_TRUE(forecast.ok()) << forecast.status();
  const motion::Clip& future = std::get<motion::Clip>(forecast->futures.at(0));
  const motion::Clip past = SwingingClip(60);
  ASSERT_EQ(future.num_frames(), 30);
  EXPECT_TRUE(future.skeleton()->SameAs(*past.skeleton(), 1e-6));
  EXPECT_LT((future.root_position(29) - past.root_position(59)).norm(), 1e-6);
  EXPECT_LT(math::GeodesicDistance(future.rotation(29, 5), past.rotation(59, 5)), 1e-5);
}

TEST(PredictionServiceTest, AnswersInTheUnitAndChannelsOfABvhSource) {
  TestServer server;
  motion::SourceConvention metres;
  const std::string bvh = motion::EncodeBvh(SwingingClip(30), metres);
  v1::PredictRequest request = Request("constant-velocity@1");
  request.mutable_source()->mutable_file()->set_name("swing.bvh");
  request.mutable_source()->mutable_file()->set_data(bvh);
  request.set_output(v1::OUTPUT_ENCODING_BVH);
  v1::PredictResponse response;
  const grpc::Status status = Predict(server, request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response.files_size(), 1);
  const std::string& answer = response.files(0).data();
  EXPECT_EQ(answer.substr(0, answer.find("MOTION")), bvh.substr(0, bvh.find("MOTION")));
}

// A mixer of which all weights are zero: holds the last pose.
artifacts::ModelArtifact StillModel() {
  prediction::PredictorTraining config;
  config.members = 1;
  config.mixer = {
      .past_frames = 4, .future_frames = 3, .width = 2, .groups = 1, .hidden = 2, .blocks = 1};
  const motion::SkeletonPtr skeleton = testing::Biped();
  prediction::NetworkBody body{.skeleton = skeleton, .frame_rate = 120, .joints = {1, 2}};
  artifacts::ModelArtifact model;
  model.card.family = "mixer";
  model.card.config = base::FieldsToJson(config.Fields());
  model.card.signature = body.Signature();
  model.card.normalisation = {{"body", body.ToJson()}};
  const auto add = [&](const std::string& name, std::vector<int64_t> shape, float value = 0) {
    int64_t count = 1;
    for (const int64_t n : shape) count *= n;
    model.weights.tensors[name] =
        base::TensorRecord::FromFloats(shape, std::vector<float>(count, value));
  };
  const auto layer = [&](const std::string& name, int out, int in) {
    add(name + ".weight", in == 0 ? std::vector<int64_t>{out} : std::vector<int64_t>{out, in});
    add(name + ".bias", {out});
  };
  add("past_dct", {4, 4}), add("future_dct", {3, 3}),
      add("scale", {prediction::MixerFeatures(2)}, 1);
  layer("joint_in", 2, prediction::MixerJointInputs(4));
  layer("root_in", 2, prediction::MixerRootInputs(4));
  add("names", {3, 2}), add("block0_joints", {1, 3, 3});
  layer("block0_joint_norm", 2, 0), layer("block0_within_norm", 2, 0);
  layer("block0_up", 2, 2), layer("block0_down", 2, 2), layer("out_norm", 2, 0);
  layer("joint_out", 9, 2), layer("root_out", 18, 2);
  model.card.weights_sha256 = artifacts::WeightsDigest(model.weights);
  return model;
}

TEST(PredictionServiceTest, ServesTheTrainedModelsOfTheRegistryByVersion) {
  TestServer server;
  artifacts::ModelArtifact model = StillModel();
  for (int version = 1; version <= 2; ++version) {
    model.card.seed = version;
    const auto stored = server.engine().artifacts().Put(artifacts::PackModel(model));
    ASSERT_TRUE(stored.ok()) << stored.status();
    ASSERT_TRUE(server.engine().models().Import("still", stored->name).ok());
  }
  for (const auto& [name, version] :
       {std::pair("still", "2"), std::pair("still@1", "1"), std::pair("still@2", "2")}) {
    v1::PredictRequest request = Request(name);
    request.set_horizon_s(0.02);
    v1::PredictResponse response;
    const grpc::Status status = Predict(server, request, &response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(response.model(), "still");
    EXPECT_EQ(response.version(), version);
    EXPECT_EQ(response.frame_times_s_size(), 2);
  }
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"still@3", "UNKNOWN_VERSION"}, {"stil", "UNKNOWN_MODEL"}, {"no model", "BAD_MODEL_NAME"}};
  for (const auto& [name, reason] : wrong) {
    v1::PredictResponse response;
    const Status error = convert::FromGrpc(Predict(server, Request(name), &response));
    EXPECT_EQ(base::ErrorReason(error), reason) << error;
    EXPECT_EQ(base::ErrorField(error), "model");
  }
  v1::PredictResponse response;
  const Status error = convert::FromGrpc(Predict(server, Request("still"), &response));
  EXPECT_EQ(base::ErrorReason(error), "HORIZON_TOO_LONG") << error;
}

TEST(PredictionServiceTest, EveryErrorNamesItsReasonAndField) {
  TestServer server;
  using R = v1::PredictRequest;
  const std::vector<std::tuple<std::string, std::string, grpc::StatusCode, void (*)(R&)>> cases = {
      {"UNKNOWN_MODEL", "model", grpc::StatusCode::NOT_FOUND,
       [](R& r) { r.set_model("zero-velocty"); }},
      {"UNKNOWN_VERSION", "model", grpc::StatusCode::NOT_FOUND,
       [](R& r) { r.set_model("zero-velocity@7"); }},
      {"BAD_HORIZON", "horizon_s", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.set_horizon_s(-1); }},
      {"BAD_HORIZON", "horizon_s", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.set_horizon_s(std::numeric_limits<double>::quiet_NaN()); }},
      {"BAD_HORIZON", "horizon_s", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.set_horizon_s(0.001); }},
      {"BAD_SAMPLE_COUNT", "samples", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.set_samples(-2); }},
      {"TOO_FEW_FRAMES", "source", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) {
         r.set_model("constant-velocity");
         *r.mutable_source()->mutable_clip() = convert::ToProto(SwingingClip(1));
       }},
      {"EMPTY_SOURCE", "source.source", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.clear_source(); }},
      {"NOT_FINITE", "source.clip.rotations", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) {
         r.mutable_source()->mutable_clip()->set_rotations(9,
                                                           std::numeric_limits<float>::quiet_NaN());
       }},
      {"NOT_A_ROTATION", "source.clip.rotations", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.mutable_source()->mutable_clip()->set_rotations(8, 3); }},
      {"WRONG_SHAPE", "source.clip.rotations", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.mutable_source()->mutable_clip()->add_rotations(1); }},
      {"WRONG_SHAPE", "visible", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.mutable_visible()->add_visible(true); }},
      {"UNKNOWN_OUTPUT", "output", grpc::StatusCode::INVALID_ARGUMENT,
       [](R& r) { r.set_output(static_cast<v1::OutputEncoding>(9)); }},
  };
  for (const auto& [reason, field, code, change] : cases) {
    v1::PredictRequest request = Request();
    change(request);
    v1::PredictResponse response;
    const grpc::Status status = Predict(server, request, &response);
    EXPECT_EQ(status.error_code(), code) << reason;
    const Status error = convert::FromGrpc(status);
    EXPECT_EQ(base::ErrorReason(error), reason) << status.error_message();
    EXPECT_NE(base::ErrorField(error).find(field), std::string::npos)
        << reason << ": " << base::ErrorField(error);
  }
}

TEST(PredictionServiceTest, BytesThatAreNoRequestAreRefused) {
  TestServer server;
  const grpc::Status status = testing::RawCall(
      server.channel(), "/poise.v1.PredictionService/Predict", "\xff\xff\xff no request");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(testing::ErrorInfoOf(status).reason(), "MALFORMED_REQUEST");
}

/// The network that comes with the program, behind a server that takes few requests at a time.
class ShippedPredictorTest : public ::testing::Test {
 protected:
  static v1::PredictRequest ShippedRequest(int frames = 60) {
    v1::PredictRequest request = Request("predictor-cmu");
    *request.mutable_source()->mutable_clip() = convert::ToProto(SwingingClip(frames, 60));
    return request;
  }
  TestServer server_{{},
                     engine::EngineConfig{.data_dir = {},
                                          .shipped_models = POISE_SOURCE_DIR "/models",
                                          .serving = {.max_requests = 2}}};
};

TEST_F(ShippedPredictorTest, WhatTheNetworkCannotAnswerIsRefusedWithReasonAndField) {
  using R = v1::PredictRequest;
  const std::vector<std::tuple<std::string, std::string, void (*)(R&)>> cases = {
      {"TOO_FEW_FRAMES", "source",
       [](R& r) { *r.mutable_source()->mutable_clip() = convert::ToProto(SwingingClip(9, 60)); }},
      {"FRAME_RATE_TOO_LOW", "source",
       [](R& r) { r.mutable_source()->mutable_clip()->set_frame_rate(20); }},
      {"HORIZON_TOO_LONG", "horizon_s", [](R& r) { r.set_horizon_s(0.5); }},
      {"BAD_HORIZON", "horizon_s", [](R& r) { r.set_horizon_s(-0.1); }},
      {"UNKNOWN_VERSION", "model", [](R& r) { r.set_model("predictor-cmu@99"); }},
      {"UNKNOWN_MODEL", "model", [](R& r) { r.set_model("predictor-cmv"); }},
      {"NOT_FINITE", "source.clip.root_positions",
       [](R& r) {
         r.mutable_source()->mutable_clip()->set_root_positions(
             0, std::numeric_limits<float>::infinity());
       }},
      {"NOT_A_ROTATION", "source.clip.rotations",
       [](R& r) { r.mutable_source()->mutable_clip()->set_rotations(0, 2); }},
  };
  for (const auto& [reason, field, change] : cases) {
    v1::PredictRequest request = ShippedRequest();
    change(request);
    v1::PredictResponse response;
    const Status error = convert::FromGrpc(Predict(server_, request, &response));
    EXPECT_EQ(base::ErrorReason(error), reason) << error;
    EXPECT_NE(base::ErrorField(error).find(field), std::string::npos)
        << reason << ": " << base::ErrorField(error);
  }
  v1::PredictResponse response;
  EXPECT_TRUE(Predict(server_, ShippedRequest(), &response).ok()) << "and goes on answering";
}

TEST_F(ShippedPredictorTest, TooManyRequestsAreRefusedWithATimeToComeAgain) {
  std::atomic<int> answered = 0, refused = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 12; ++i) {
    clients.emplace_back([&] {
      for (int call = 0; call < 5; ++call) {
        v1::PredictResponse response;
        const Status error = convert::FromGrpc(Predict(server_, ShippedRequest(), &response));
        if (error.ok()) {
          ++answered;
          continue;
        }
        ++refused;
        EXPECT_EQ(base::ErrorReason(error), "MODEL_BUSY") << error;
        EXPECT_TRUE(absl::IsResourceExhausted(error));
        EXPECT_TRUE(base::RetryDelay(error).has_value());
      }
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_GT(answered, 0);
  EXPECT_EQ(answered + refused, 60);
  const std::string metrics = server_.telemetry().Text();
  for (const char* name : {"poise_predict_refused_total", "poise_predict_requests",
                           "poise_predict_batches_total", "poise_predict_wait_seconds"}) {
    EXPECT_NE(metrics.find(std::string(name)), std::string::npos) << name;
  }
  EXPECT_NE(metrics.find("model=\"predictor-cmu@1\""), std::string::npos);
}

TEST(PredictionServiceTest, AFutureTooLargeForAMessageIsRefused) {
  TestServer server;
  v1::PredictRequest request = Request();
  request.mutable_source()->mutable_clip()->set_frame_rate(9000);
  request.set_horizon_s(11);
  v1::PredictResponse response;
  EXPECT_EQ(base::ErrorReason(convert::FromGrpc(Predict(server, request, &response))),
            "REQUEST_TOO_LARGE");
}

}  // namespace
}  // namespace poise::server
