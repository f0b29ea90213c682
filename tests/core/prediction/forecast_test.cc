#include "core/prediction/forecast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/editing/cut.h"
#include "core/prediction/predictor_registry.h"
#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

using motion::Clip;
using motion::JointRoles;
using motion::Quat;
using motion::Vec3;

// Knows the motion: a pose is a function of time since the clip began, at any rate.
Clip Motion(double from_s, int frames, double rate) {
  const motion::SkeletonPtr skeleton = testing::Biped();
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = 0; frame < frames; ++frame) {
    const double t = from_s + frame / rate;
    positions.emplace_back(0.5 * t, 1, 0.2 * t);
    for (int joint = 0; joint < skeleton->num_joints(); ++joint) {
      rotations.push_back(math::FromRotationVector(
          Vec3(0.4 * std::sin(3 * t + joint), 0.2 * std::cos(2 * t), 0.1 * t)));
    }
  }
  return *Clip::Create("motion", skeleton, rate, positions, rotations);
}

// Continues Motion() at its own rate, from a past that it checks.
class Oracle : public Predictor {
 public:
  Oracle(double rate, int past_frames, double past_ends_s)
      : signature_{.skeleton = testing::Biped(),
                   .frame_rate = rate,
                   .past_frames = past_frames,
                   .max_future_frames = 25},
        past_ends_s_(past_ends_s) {}
  const PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                      const base::RunContext&) const override {
    POISE_RETURN_IF_ERROR(CheckObservations(signature_, batch, future_frames));
    seen_ = batch.front().past;
    const double step = 1 / signature_.frame_rate;
    return std::vector<Clip>{Motion(past_ends_s_ + step, future_frames, signature_.frame_rate)};
  }
  mutable std::optional<Clip> seen_;

 private:
  PredictorSignature signature_;
  double past_ends_s_;
};

double LargestAngle(const Clip& a, const Clip& b) {
  double largest = 0;
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    for (int joint = 0; joint < a.num_joints(); ++joint) {
      largest = std::max(
          largest, math::GeodesicDistance(a.rotation(frame, joint), b.rotation(frame, joint)));
    }
  }
  return largest;
}

class ForecastTest : public ::testing::Test {
 protected:
  JointRoles roles_ = *JointRoles::Detect(*testing::Biped());
};

TEST_F(ForecastTest, ClipAtAnotherRateIsSampledInSecondsAndBack) {
  for (const double rate : {30.0, 50.0, 60.0, 100.0, 120.0, 240.0}) {
    const int frames = static_cast<int>(rate) + 1;  // one second
    const Oracle oracle(60, 20, 1.0);
    const auto future = Forecast(oracle, Motion(0, frames, rate), {}, roles_, 0.4, {});
    ASSERT_TRUE(future.ok()) << rate << ": " << future.status();
    const int expected = static_cast<int>(0.4 * rate + 1e-6);
    ASSERT_EQ(future->clip.num_frames(), expected);
    EXPECT_EQ(future->clip.frame_rate(), rate);
    EXPECT_DOUBLE_EQ(future->times_s.back(), expected / rate);
    // Between two frames of the model a pose is interpolated.
    EXPECT_LT(LargestAngle(future->clip, Motion(1 + 1 / rate, expected, rate)), 1e-3) << rate;
    EXPECT_NEAR(future->clip.root_position(expected - 1).x(), 0.5 * (1 + expected / rate), 1e-9);
    EXPECT_LT(LargestAngle(*oracle.seen_, Motion(1 - 19 / 60.0, 20, 60)), 2e-3) << rate;
  }
}

TEST_F(ForecastTest, HorizonsThatCannotBeAreRefusedInSeconds) {
  const Oracle oracle(60, 20, 1.0);
  const Clip past = Motion(0, 121, 120);
  for (const double horizon : {0.0, -1.0, 0.001, 1e9, std::nan("")}) {
    EXPECT_EQ(base::ErrorReason(Forecast(oracle, past, {}, roles_, horizon, {}).status()),
              "BAD_HORIZON")
        << horizon;
  }
  const Status status = Forecast(oracle, past, {}, roles_, 0.5, {}).status();
  EXPECT_EQ(base::ErrorReason(status), "HORIZON_TOO_LONG");
  EXPECT_THAT(base::Message(status), ::testing::HasSubstr("0.417 s"));
}

TEST_F(ForecastTest, PastThatIsTooShortOrTooSlowIsRefused) {
  const Oracle oracle(60, 20, 1.0);
  const Status few = Forecast(oracle, Motion(0, 38, 120), {}, roles_, 0.1, {}).status();
  EXPECT_EQ(base::ErrorReason(few), "TOO_FEW_FRAMES");
  EXPECT_THAT(base::Message(few), ::testing::HasSubstr("0.317 s"));
  EXPECT_TRUE(Forecast(oracle, Motion(0, 39, 120), {}, roles_, 0.1, {}).ok());
  const Status slow = Forecast(oracle, Motion(0, 40, 20), {}, roles_, 0.1, {}).status();
  EXPECT_EQ(base::ErrorReason(slow), "FRAME_RATE_TOO_LOW");
}

TEST_F(ForecastTest, MaskIsRefusedByAModelThatNeedsEverything) {
  const Oracle oracle(60, 20, 1.0);
  const Clip past = Motion(0, 121, 120);
  const motion::JointMask mask{std::vector<bool>(past.rotations().size(), false)};
  EXPECT_EQ(base::ErrorReason(Forecast(oracle, past, mask, roles_, 0.1, {}).status()),
            "MASKS_NOT_SUPPORTED");
}

TEST_F(ForecastTest, FloorsTakeAnyBodyWithoutRoles) {
  const auto stick = motion::Skeleton::Create({{"a", -1, Vec3::Zero(), {}}});
  const Clip past = *Clip::Create("stick", *stick, 7, std::vector<Vec3>(3, Vec3::Zero()),
                                  std::vector<Quat>(3, Quat::Identity()));
  const auto future = Forecast(*FindBuiltInPredictor("zero-velocity"), past, {},
                               *JointRoles::Detect(**stick), 1, {});
  ASSERT_TRUE(future.ok()) << future.status();
  EXPECT_EQ(future->clip.num_frames(), 7);
}

}  // namespace
}  // namespace poise::prediction
