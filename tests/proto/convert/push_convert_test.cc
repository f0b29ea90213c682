#include "proto/convert/push_convert.h"

#include <gmock/gmock.h>

#include "tests/support/test_clips.h"

namespace poise::convert {
namespace {

TEST(PushConvertTest, ASpecComesBackAsItWas) {
  api::PushSpec spec;
  api::PushPerson anna{.id = "anna",
                       .body = std::nullopt,
                       .frame = 3,
                       .mass_kg = 61,
                       .place = motion::Vec3(1, 0, -2)};
  anna.body = api::ClipSource{testing::SwingingClip(4), {}};
  spec.people = {anna, {}};
  spec.pushes = {{.person = 1,
                  .start_s = 0.5,
                  .duration_s = 0.25,
                  .impulse_ns = motion::Vec3(20, 0, -5),
                  .height = 1.2}};
  spec.duration_s = 3;
  spec.overrides = {{"physics.friction", "2"}};
  const auto back = FromProto(ToProto(spec));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->people[0].id, "anna");
  EXPECT_EQ(back->people[0].frame, 3);
  EXPECT_EQ(back->people[0].mass_kg, 61);
  EXPECT_EQ(*back->people[0].place, motion::Vec3(1, 0, -2));
  ASSERT_TRUE(back->people[0].body.has_value());
  EXPECT_FALSE(back->people[1].body.has_value());
  EXPECT_FALSE(back->people[1].place.has_value());
  EXPECT_EQ(back->pushes[0].impulse_ns, spec.pushes[0].impulse_ns);
  EXPECT_EQ(back->pushes[0].height, 1.2);
  EXPECT_EQ(back->overrides, spec.overrides);
}

TEST(PushConvertTest, AForceIsAnImpulseOverItsDuration) {
  v1::PushForecastRequest request;
  request.add_people()->set_mass_kg(70);
  v1::PushForce* push = request.add_pushes();
  push->set_duration_s(0.1);
  push->mutable_force_n()->set_x(300);
  const auto spec = FromProto(request);
  ASSERT_TRUE(spec.ok()) << spec.status();
  EXPECT_NEAR(spec->pushes[0].impulse_ns.x(), 30, 1e-12);
  EXPECT_EQ(spec->pushes[0].height, 1);
}

TEST(PushConvertTest, AFrameComesBackAsItWas) {
  api::PushForecastFrame frame{.index = 7, .time_s = 0.5, .people = {{}}};
  api::PushPersonFrame& person = frame.people[0];
  person.rotations = {motion::Quat::Identity(), motion::Quat(0, 1, 0, 0)};
  person.pendulum = {1, 2, 3, 4};
  person.interaction_force = {5, 6, 7, 8};
  person.rod_m = 0.9;
  person.hip = {1, 2, 3};
  person.onset_s = 0.25;
  const auto back = FromProto(ToProto(frame));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->index, 7);
  EXPECT_EQ(back->people[0].pendulum, person.pendulum);
  EXPECT_EQ(back->people[0].interaction_force, person.interaction_force);
  EXPECT_EQ(back->people[0].hip, person.hip);
  EXPECT_EQ(back->people[0].onset_s, person.onset_s);
  EXPECT_EQ(back->people[0].rotations[1].x(), 1);
}

TEST(PushConvertTest, FramesOfTheWrongShapeAreRefused) {
  v1::PushForecastFrame frame;
  frame.add_people()->add_pendulum(1);
  EXPECT_EQ(base::ErrorReason(FromProto(frame).status()), "WRONG_SHAPE");
}

}  // namespace
}  // namespace poise::convert
