#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/artifacts/model_artifact.h"
#include "core/motion/editing/cut.h"
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

TEST(PredictionServiceTest, AFutureTooLargeForAMessageIsRefused) {
  TestServer server;
  v1::PredictRequest request = Request();
  request.mutable_source()->mutable_clip()->set_frame_rate(9000);
  request.set_horizon_s(11);
  v1::PredictResponse response;
  EXPECT_EQ(base::ErrorReason(convert::FromGrpc(Predict(server, request, &response))),
            "REQUEST_TOO_LARGE");
}

/// A stream of forecasts, one message at a time.
class Stream {
 public:
  explicit Stream(TestServer& server)
      : stub_(v1::PredictionService::NewStub(server.channel())),
        stream_(stub_->PredictStream(&context_)) {}

  void SendSetup(const std::string& model, double horizon_s = 0.1) {
    v1::PredictStreamRequest request;
    *request.mutable_setup() = convert::ToProto(api::ForecastStreamSpec{
        .model = model, .horizon_s = horizon_s, .skeleton = testing::Biped(), .frame_rate = 120});
    stream_->Write(request);
  }
  void SendFrames(const motion::Clip& clip, int first, int count) {
    v1::PredictStreamRequest request;
    *request.mutable_frames() = convert::ToObservedFrames(*motion::Cut(clip, first, count));
    stream_->Write(request);
  }
  bool Read() { return stream_->Read(&response_); }
  void WritesDone() { stream_->WritesDone(); }
  grpc::Status Finish() { return stream_->Finish(); }
  const v1::PredictStreamResponse& response() const { return response_; }
  grpc::ClientContext& context() { return context_; }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<v1::PredictionService::Stub> stub_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::PredictStreamRequest, v1::PredictStreamResponse>>
      stream_;
  v1::PredictStreamResponse response_;
};

TEST(PredictStreamTest, EveryFrameIsAnsweredOnceThereAreEnough) {
  TestServer server;
  const motion::Clip clip = SwingingClip(50);
  Stream stream(server);
  stream.SendSetup("constant-velocity");
  stream.SendFrames(clip, 0, 1);  // a velocity needs two
  for (int frame = 1; frame < 50; ++frame) {
    stream.SendFrames(clip, frame, 1);
    ASSERT_TRUE(stream.Read()) << frame;
    EXPECT_EQ(stream.response().observed_frames(), frame + 1);
    EXPECT_EQ(stream.response().frame_times_s_size(), frame == 1 ? 12 : 0);
    EXPECT_EQ(stream.response().model(), frame == 1 ? "constant-velocity" : "");
  }
  // The last answer is the one that the unary method gives for the whole clip.
  v1::PredictRequest request = Request("constant-velocity");
  *request.mutable_source()->mutable_clip() = convert::ToProto(clip);
  request.set_horizon_s(0.1);
  v1::PredictResponse whole;
  ASSERT_TRUE(Predict(server, request, &whole).ok());
  ASSERT_EQ(stream.response().rotations_size(), whole.clips(0).rotations_size());
  for (int i = 0; i < whole.clips(0).rotations_size(); ++i) {
    EXPECT_NEAR(stream.response().rotations(i), whole.clips(0).rotations(i), 1e-5) << i;
  }
  stream.WritesDone();
  EXPECT_FALSE(stream.Read());
  EXPECT_TRUE(stream.Finish().ok());
}

TEST(PredictStreamTest, SeveralFramesInOneMessageAreAnsweredOnce) {
  TestServer server;
  Stream stream(server);
  stream.SendSetup("zero-velocity");
  stream.SendFrames(SwingingClip(50), 0, 20);
  stream.SendFrames(SwingingClip(50), 20, 30);
  ASSERT_TRUE(stream.Read());
  EXPECT_EQ(stream.response().observed_frames(), 20);
  ASSERT_TRUE(stream.Read());
  EXPECT_EQ(stream.response().observed_frames(), 50);
  stream.WritesDone();
  EXPECT_FALSE(stream.Read());
  EXPECT_TRUE(stream.Finish().ok());
}

TEST(PredictStreamTest, BrokenMessagesEndTheStreamWithTheReason) {
  TestServer server;
  const auto reason = [](Stream& stream) {
    while (stream.Read()) {
    }
    return base::ErrorReason(convert::FromGrpc(stream.Finish()));
  };
  Stream without_setup(server);
  without_setup.SendFrames(SwingingClip(5), 0, 5);
  EXPECT_EQ(reason(without_setup), "MISSING_SETUP");
  Stream twice(server);
  twice.SendSetup("zero-velocity");
  twice.SendSetup("zero-velocity");
  EXPECT_EQ(reason(twice), "UNEXPECTED_MESSAGE");
  Stream unknown(server);
  unknown.SendSetup("clairvoyant");
  EXPECT_EQ(reason(unknown), "UNKNOWN_MODEL");
  Stream far(server);
  far.SendSetup("zero-velocity", 61);
  EXPECT_EQ(reason(far), "BAD_HORIZON");
}

TEST(PredictStreamTest, ClientThatGoesAwayLeavesNothingBehind) {
  TestServer server;
  {
    Stream stream(server);
    stream.SendSetup("zero-velocity");
    stream.SendFrames(SwingingClip(5), 0, 5);
    ASSERT_TRUE(stream.Read());
    stream.context().TryCancel();
    EXPECT_EQ(stream.Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  const absl::Time end = absl::Now() + absl::Seconds(10);
  while (server.server().calls() > 0 && absl::Now() < end) absl::SleepFor(absl::Milliseconds(5));
  EXPECT_EQ(server.server().calls(), 0);
}

TEST(PredictStreamTest, DeadlineEndsAStreamThatIsSilent) {
  ServerConfig config;
  config.methods.predict_stream = {.default_deadline = absl::Milliseconds(200),
                                   .max_deadline = absl::Milliseconds(200)};
  TestServer server(config);
  Stream stream(server);
  stream.SendSetup("zero-velocity");
  EXPECT_FALSE(stream.Read());
  EXPECT_FALSE(stream.Finish().ok());
}

}  // namespace
}  // namespace poise::server
