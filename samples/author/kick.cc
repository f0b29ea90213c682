#include "samples/author/idle.h"
#include "samples/author/samples.h"

namespace poise::samples {
namespace {

constexpr auto kRest = Pass::kRest;

// Phases [s]: 0 stance, 0.30 push off, 0.52 toes leave, 0.74 chamber, 0.90 full extension,
// 1.05 recoil, 1.42 landing, 1.8 settled.

void SetTrunk(Performance& kick) {
  kick.pelvis = WithIdle(
      VectorTrack{
          {0.00, {-0.010, 0.900, -0.035}},
          {0.22, {-0.006, 0.884, -0.042}},
          {0.50, {0.048, 0.908, 0.090}},
          {0.72, {0.078, 0.930, 0.152}},
          {0.90, {0.080, 0.934, 0.200}},
          {1.08, {0.074, 0.922, 0.160}},
          {1.40, {0.034, 0.892, 0.025}},
          {1.64, {-0.008, 0.882, -0.042}},
          {1.98, {-0.012, 0.898, -0.036}},
          {2.30, {-0.010, 0.899, -0.035}},
      },
      0.002, 0.0);
  kick.pelvis_turn = VectorTrack{
      {0.00, {-32, 5, 0}},  {0.20, {-35, 7, -1}}, {0.50, {-10, 4, 2}}, {0.72, {8, -8, 5}},
      {0.90, {20, -15, 9}}, {1.07, {10, -9, 5}},  {1.40, {-22, 3, 1}}, {1.64, {-35, 7, 0}},
      {2.00, {-32, 5, 0}},  {2.30, {-32, 5, 0}},
  };
  kick.chest_turn = WithIdle(
      VectorTrack{
          {0.00, {-30, 9, 0}},
          {0.22, {-34, 11, 1}},
          {0.50, {-12, 8, 2}},
          {0.72, {-2, -4, 4}},
          {0.91, {2, -13, 6}},
          {1.08, {-4, -4, 3}},
          {1.42, {-24, 8, 0}},
          {1.68, {-33, 11, 0}},
          {2.05, {-30, 9, 0}},
          {2.30, {-30, 9, 0}},
      },
      0.4, 0.7);
  kick.head_turn = WithIdle(
      VectorTrack{
          {0.00, {-3, 5, 0}},
          {0.30, {-5, 7, 0}},
          {0.72, {0, 6, 2}},
          {0.92, {2, 2, 3}},
          {1.12, {0, 7, 1}},
          {1.48, {-3, 8, 0}},
          {1.80, {-4, 5, 0}},
          {2.30, {-3, 5, 0}},
      },
      0.4, 1.9);
}

void SetLegs(Performance& kick) {
  LegScript& left = kick.leg(Side::kLeft);
  left.ball = [](double) { return Vec3(0.105, 0, 0.30); };
  // The standing foot opens on its ball as the hip comes round.
  left.foot = VectorTrack{
      {0.00, {2, 0, 0}},        {0.40, {2, 0, 0}, kRest}, {0.88, {24, 0, 7}},
      {1.35, {8, 0, 0}, kRest}, {2.30, {8, 0, 0}},
  };
  left.knee_out = [](double) { return 2.0; };

  LegScript& right = kick.leg(Side::kRight);
  right.ball = VectorTrack{
      {0.00, {-0.130, 0, -0.215}},          {0.46, {-0.130, 0, -0.215}, kRest},
      {0.70, {-0.090, 0.22, 0.000}, kRest}, {1.10, {-0.085, 0.20, -0.020}, kRest},
      {1.46, {-0.120, 0, -0.228}, kRest},   {2.30, {-0.120, 0, -0.228}},
  };
  right.foot = VectorTrack{
      {0.00, {42, 0, 7}},  {0.20, {42, 0, 5}},  {0.50, {26, 0, 60}},
      {0.64, {18, 0, 58}}, {1.10, {20, 0, 45}}, {1.44, {36, 0, 34}},
      {1.66, {42, 0, 4}},  {1.98, {43, 0, 7}},  {2.30, {43, 0, 7}},
  };
  right.knee_out = [](double) { return 0.0; };
  right.free.weight = ScalarTrack{
      {0.00, 0}, {0.46, 0, kRest}, {0.68, 1, kRest}, {1.12, 1, kRest}, {1.44, 0, kRest}, {2.30, 0},
  };
  right.free.angles = VectorTrack{
      {0.40, {0, 6, 60}},   {0.58, {36, 6, 96}}, {0.745, {88, 3, 120}}, {0.90, {106, -3, 15}},
      {1.05, {88, 0, 100}}, {1.22, {40, 6, 88}}, {1.44, {2, 8, 62}},    {1.70, {0, 8, 60}},
  };
  right.free.roll =
      ScalarTrack{{0.40, 14}, {0.75, 6}, {0.90, -2}, {1.06, 4}, {1.45, 20}, {1.7, 20}};
  right.free_dorsiflexion = ScalarTrack{
      {0.45, -20}, {0.62, -12}, {0.76, 4}, {0.90, -24}, {1.06, -2}, {1.25, -18}, {1.50, -12},
  };
}

void SetArms(Performance& kick) {
  ArmScript& left = kick.arm(Side::kLeft);
  left.wrist = VectorTrack{
      {0.00, {0.095, 0.000, 0.385}},  {0.28, {0.085, 0.015, 0.370}},
      {0.56, {0.130, -0.020, 0.350}}, {0.90, {0.235, -0.085, 0.300}},
      {1.10, {0.190, -0.060, 0.320}}, {1.46, {0.100, -0.005, 0.375}},
      {1.75, {0.090, 0.008, 0.392}},  {2.30, {0.095, 0.000, 0.387}},
  };
  left.elbow = [](double) { return Vec3(0.45, -1, -0.15); };
  left.collar = [](double) { return Vec3(12, 3, 0); };
  left.hand = [](double) { return Vec3(60, -5, 0); };

  ArmScript& right = kick.arm(Side::kRight);
  right.wrist = VectorTrack{
      {0.00, {0.030, -0.030, 0.285}},  {0.26, {0.020, -0.020, 0.280}},
      {0.55, {0.110, -0.080, 0.240}},  {0.74, {0.260, -0.260, 0.120}},
      {0.92, {0.370, -0.400, -0.050}}, {1.10, {0.330, -0.320, 0.060}},
      {1.42, {0.120, -0.090, 0.240}},  {1.70, {0.030, -0.025, 0.290}},
      {2.30, {0.032, -0.030, 0.286}},
  };
  right.elbow = VectorTrack{{0.0, {0.5, -1, -0.2}},
                            {0.45, {0.5, -1, -0.3}},
                            {0.9, {0.7, -0.3, -0.9}},
                            {1.4, {0.5, -1, -0.3}},
                            {2.3, {0.5, -1, -0.2}}};
  right.collar = VectorTrack{
      {0.0, {10, 3, 0}}, {0.5, {8, 3, 0}}, {0.9, {-6, 0, 0}}, {1.5, {10, 3, 0}}, {2.3, {10, 3, 0}}};
  right.hand = [](double) { return Vec3(60, -5, 0); };
}

}  // namespace

Performance Kick() {
  Performance kick;
  kick.name = "kick";
  kick.seconds = 2.25;
  SetTrunk(kick);
  SetLegs(kick);
  SetArms(kick);
  return kick;
}

}  // namespace poise::samples
