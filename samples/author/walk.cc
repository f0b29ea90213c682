#include <cmath>
#include <numbers>

#include "samples/author/samples.h"

namespace poise::samples {
namespace {

constexpr auto kRest = Pass::kRest;
constexpr double kCycle = 1.08;   // [s] from one left heel strike to the next
constexpr double kStride = 1.26;  // [m] in that time
constexpr double kSpeed = kStride / kCycle;
constexpr double kStart = -0.16;  // [cycles] where in the gait the clip begins

// Gait phase in cycles; the left heel strikes at whole numbers, the right one at about a half.
double Phase(double time) { return kStart + time / kCycle; }

double Wave(double phase, double peak) { return std::cos(2 * std::numbers::pi * (phase - peak)); }

struct FootHabits {
  double strike;     // [cycles] phase of the heel strike
  double lateral;    // [m] of the ball
  double toe_out;    // [deg]
  double clearance;  // factor on the swing's height
};

void SetLeg(Performance& walk, Side side, const FootHabits& habits) {
  std::vector<Key<Vec3>> ball, foot;
  for (int step = -2; step <= 4; ++step) {
    const auto time = [&](double phase) {
      return (step + habits.strike + phase - kStart) * kCycle;
    };
    const auto place = [&](double share, double height) {
      return Vec3(habits.lateral, height * habits.clearance,
                  (step + habits.strike - kStart + share) * kStride + 0.405);
    };
    ball.push_back({time(0.00), place(0, 0), kRest});
    ball.push_back({time(0.575), place(0, 0), kRest});
    ball.push_back({time(0.69), place(0.19, 0.064)});
    ball.push_back({time(0.79), place(0.51, 0.052)});
    ball.push_back({time(0.88), place(0.85, 0.034)});
    ball.push_back({time(0.95), place(0.985, 0.018)});
    const double out = habits.toe_out;
    foot.push_back({time(0.00), {out, 19, 0}});
    foot.push_back({time(0.10), {out, 0, 0}, kRest});
    foot.push_back({time(0.28), {out, 0, 0}, kRest});
    foot.push_back({time(0.42), {out, 0, 9}});
    foot.push_back({time(0.50), {out, 0, 16}});
    foot.push_back({time(0.61), {out + 2, 0, 55}});
    foot.push_back({time(0.71), {out + 2, 0, 42}});
    foot.push_back({time(0.83), {out, 5, 6}});
    foot.push_back({time(0.94), {out, 17, 0}});
  }
  LegScript& leg = walk.leg(side);
  leg.ball = VectorTrack(ball);
  leg.foot = VectorTrack(foot);
  leg.knee_out = [](double) { return -2.0; };
}

void SetArm(Performance& walk, Side side, double forward_phase, double swing, double bend) {
  ArmScript& arm = walk.arm(side);
  arm.free.weight = [](double) { return 1.0; };
  arm.free.angles = [=](double time) {
    const double p = Phase(time);
    return Vec3(-3 + swing * Wave(p, forward_phase), 9 + 1.5 * Wave(p, forward_phase + 0.5),
                bend + 12 * Wave(p, forward_phase + 0.04) + 2 * Wave(2 * p, 0.3));
  };
  arm.free.roll = [](double) { return -22.0; };
  arm.hand = [](double) { return Vec3(70, 8, 0); };
  arm.collar = [=](double time) { return Vec3(3 * Wave(Phase(time), forward_phase), -2, 0); };
}

}  // namespace

Performance Walk() {
  Performance walk;
  walk.name = "walk";
  walk.seconds = 2.7;
  walk.pelvis = [](double time) {
    const double p = Phase(time);
    return Vec3(0.020 * Wave(p, 0.32) + 0.003 * Wave(p, 0.1),
                0.931 + 0.012 * Wave(2 * p, 2 * 0.31) + 0.002 * Wave(p, 0.3),
                kSpeed * time + 0.008 * Wave(2 * p, 0.1));
  };
  walk.pelvis_turn = [](double time) {
    const double p = Phase(time);
    return Vec3(-5 * Wave(p, 0.0) + 0.5, 3 + 1.0 * Wave(2 * p, 0.2), -3.5 * Wave(p, 0.16));
  };
  walk.chest_turn = [](double time) {
    const double p = Phase(time);
    return Vec3(6 * Wave(p, 0.02) - 0.5, 4 + 1.2 * Wave(2 * p, 0.3), 1.2 * Wave(p, 0.25));
  };
  walk.head_turn = [](double time) {
    const double p = Phase(time);
    return Vec3(1.5 * Wave(p, 0.1), 5 - 1.0 * Wave(2 * p, 0.3), 0.6 * Wave(p, 0.3));
  };
  SetLeg(walk, Side::kLeft, {.strike = 0.0, .lateral = 0.082, .toe_out = 7, .clearance = 1.0});
  SetLeg(walk, Side::kRight, {.strike = 0.495, .lateral = -0.078, .toe_out = 9, .clearance = 1.06});
  SetArm(walk, Side::kLeft, 0.51, 21, 24);
  SetArm(walk, Side::kRight, 0.02, 23, 27);
  return walk;
}

}  // namespace poise::samples
