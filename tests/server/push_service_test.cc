#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/push/standing_person.h"
#include "poise/v1/push_service.grpc.pb.h"
#include "proto/convert/clip_convert.h"
#include "proto/convert/push_convert.h"
#include "proto/convert/status_convert.h"
#include "tests/support/test_clips.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::TestServer;

v1::PushForecastRequest LineRequest(int people, double duration_s = 1) {
  v1::PushForecastRequest request;
  for (int i = 0; i < people; ++i) {
    v1::PushPerson* person = request.add_people();
    person->set_mass_kg(75);
    person->mutable_place()->set_x(0.35 * i);
  }
  v1::PushForce* push = request.add_pushes();
  push->set_duration_s(0.2);
  push->mutable_impulse_ns()->set_x(65);
  request.set_duration_s(duration_s);
  return request;
}

struct Answer {
  std::optional<api::PushForecastScene> scene;
  std::vector<api::PushForecastFrame> frames;
  Status status;
};

Answer Forecast(TestServer& server, const v1::PushForecastRequest& request,
                int stop_after = std::numeric_limits<int>::max()) {
  Answer answer;
  grpc::ClientContext context;
  const auto stub = v1::PushService::NewStub(server.channel());
  const auto reader = stub->Forecast(&context, request);
  v1::PushForecastResponse response;
  while (reader->Read(&response)) {
    if (response.has_scene()) {
      answer.scene = *convert::FromProto(response.scene());
    } else {
      answer.frames.push_back(*convert::FromProto(response.frame()));
    }
    if (static_cast<int>(answer.frames.size()) == stop_after) context.TryCancel();
  }
  answer.status = convert::FromGrpc(reader->Finish());
  return answer;
}

TEST(PushServiceTest, StreamsTheSceneAndThenEveryFrame) {
  TestServer server;
  const Answer answer = Forecast(server, LineRequest(10));
  ASSERT_TRUE(answer.status.ok()) << answer.status;
  ASSERT_TRUE(answer.scene.has_value());
  EXPECT_EQ(answer.scene->people.size(), 10u);
  EXPECT_EQ(answer.scene->frames, 61);
  ASSERT_EQ(answer.frames.size(), 61u);
  for (int i = 0; i < 61; ++i) EXPECT_EQ(answer.frames[i].index, i);
  const auto& last = answer.frames.back().people;
  ASSERT_EQ(last.size(), 10u);
  EXPECT_TRUE(last[0].onset_s.has_value());
  EXPECT_GT(last[0].hip.x(), answer.frames[0].people[0].hip.x() + 0.05);
  EXPECT_NE(answer.frames[20].people[1].interaction_force[0], 0);
}

TEST(PushServiceTest, TheSameRequestGivesTheSameFrames) {
  TestServer server;
  const Answer first = Forecast(server, LineRequest(5)), second = Forecast(server, LineRequest(5));
  ASSERT_EQ(first.frames.size(), second.frames.size());
  for (size_t i = 0; i < first.frames.size(); ++i) {
    for (int p = 0; p < 5; ++p) {
      EXPECT_EQ(first.frames[i].people[p].hip, second.frames[i].people[p].hip);
    }
  }
}

TEST(PushServiceTest, AnyBipedCanBePushedAndKeepsItsSkeletonAndPlace) {
  TestServer server;
  v1::PushForecastRequest request = LineRequest(1);
  const motion::Clip biped = testing::SwingingClip(3);
  *request.mutable_people(0)->mutable_body()->mutable_clip() = convert::ToProto(biped);
  request.mutable_people(0)->clear_place();
  const Answer answer = Forecast(server, request);
  ASSERT_TRUE(answer.status.ok()) << answer.status;
  EXPECT_TRUE(answer.scene->people[0].skeleton->SameAs(*biped.skeleton(), 1e-6));
  EXPECT_LT((answer.frames[0].people[0].root_position - biped.root_position(0)).norm(), 1e-5);
}

TEST(PushServiceTest, BadScenesAreRefusedWithReasonAndField) {
  TestServer server;
  const auto expect = [&](const v1::PushForecastRequest& request, const std::string& reason,
                          const std::string& field,
                          absl::StatusCode code = absl::StatusCode::kInvalidArgument) {
    const Status status = Forecast(server, request).status;
    EXPECT_EQ(status.code(), code) << reason;
    EXPECT_EQ(base::ErrorReason(status), reason) << status;
    EXPECT_EQ(base::ErrorField(status), field) << status;
  };
  expect(LineRequest(0), "NO_PEOPLE", "people");
  expect(LineRequest(1001), "TOO_MANY_PEOPLE", "people");
  auto overlapping = LineRequest(3);
  overlapping.mutable_people(2)->mutable_place()->set_x(0.45);
  expect(overlapping, "OVERLAPPING_PEOPLE", "people[2].place");
  for (const double mass : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    auto request = LineRequest(2);
    request.mutable_people(1)->set_mass_kg(mass);
    expect(request, "BAD_MASS", "people[1].mass_kg");
  }
  for (const double force :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e9}) {
    auto request = LineRequest(2);
    request.mutable_pushes(0)->mutable_force_n()->set_x(force);
    expect(request, "BAD_FORCE", "pushes[0].impulse_ns");
  }
  auto late = LineRequest(2);
  late.mutable_pushes(0)->set_start_s(0.9);
  expect(late, "PUSH_OUTSIDE_CLIP", "pushes[0].start_s");
  auto nobody = LineRequest(2);
  nobody.mutable_pushes(0)->set_person(2);
  expect(nobody, "UNKNOWN_PERSON", "pushes[0].person");
  auto model = LineRequest(2);
  model.set_model("oracle");
  expect(model, "UNKNOWN_MODEL", "model", absl::StatusCode::kNotFound);
  auto key = LineRequest(2);
  (*key.mutable_overrides())["physics.frictoin"] = "1";
  expect(key, "UNKNOWN_CONFIG_KEY", "physics.frictoin");
}

TEST(PushServiceTest, ACancelledForecastStopsEarly) {
  TestServer server;
  const Answer answer = Forecast(server, LineRequest(20, 600), 5);
  EXPECT_EQ(answer.status.code(), absl::StatusCode::kCancelled);
  EXPECT_LT(answer.frames.size(), 3000u);
}

TEST(PushServiceTest, ADeadlineEndsAForecast) {
  TestServer server;
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(300));
  const auto stub = v1::PushService::NewStub(server.channel());
  const auto reader = stub->Forecast(&context, LineRequest(200, 3600));
  v1::PushForecastResponse response;
  while (reader->Read(&response)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
}

}  // namespace
}  // namespace poise::server
