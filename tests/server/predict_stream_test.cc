#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/motion/editing/cut.h"
#include "poise/v1/prediction_service.grpc.pb.h"
#include "proto/convert/clip_convert.h"
#include "proto/convert/predict_convert.h"
#include "proto/convert/status_convert.h"
#include "tests/support/test_clips.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::SwingingClip;
using testing::TestServer;

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
  void Send(const v1::PredictStreamRequest& request) { stream_->Write(request); }
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
  const v1::PredictRequest request = convert::ToProto(
      api::PredictQuery{.source = {clip, {}}, .model = "constant-velocity", .horizon_s = 0.1});
  v1::PredictResponse whole;
  grpc::ClientContext context;
  ASSERT_TRUE(
      v1::PredictionService::NewStub(server.channel())->Predict(&context, request, &whole).ok());
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

TEST(PredictStreamTest, FramesThatAreNoPosesEndTheStreamWithTheReason) {
  TestServer server;
  for (const auto& [value, expected] :
       {std::pair(std::numeric_limits<float>::quiet_NaN(), "NOT_FINITE"),
        std::pair(3.0F, "NOT_A_ROTATION")}) {
    Stream stream(server);
    stream.SendSetup("zero-velocity");
    v1::PredictStreamRequest request;
    *request.mutable_frames() = convert::ToObservedFrames(SwingingClip(5));
    request.mutable_frames()->set_rotations(8, value);
    stream.Send(request);
    while (stream.Read()) {
    }
    const Status error = convert::FromGrpc(stream.Finish());
    EXPECT_EQ(base::ErrorReason(error), expected) << error;
    EXPECT_NE(base::ErrorField(error).find("frames"), std::string::npos) << error;
  }
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
