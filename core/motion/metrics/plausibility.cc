#include "core/motion/metrics/plausibility.h"

#include <fmt/format.h>

#include "core/motion/kinematics/sole_estimate.h"
#include "core/motion/metrics/floor_contact.h"
#include "core/motion/metrics/self_penetration.h"
#include "core/motion/metrics/smoothness.h"

namespace poise::motion {
namespace {

constexpr int kFewestFrames = 4;  // a third difference needs four

// Fresh pages cost more than the measures themselves, so each thread keeps its memory between
// clips, unless a clip was long.
struct Workspace {
  static constexpr size_t kMostPositionsKept = 100'000;

  WorldPoses world;
  PlacedBodies bodies;

  void Trim() {
    if (world.positions.size() > kMostPositionsKept) *this = Workspace();
  }
};

}  // namespace

std::vector<base::Field> PlausibilityConfig::Fields() {
  return {base::Number("contact_height_m", &contact_height_m, 1e-4, 1),
          base::Number("still_speed_mps", &still_speed_mps, 1e-4, 100),
          base::Number("floor_band_m", &floor_band_m, 1e-4, 10)};
}

base::Json ToJson(const Plausibility& plausibility) {
  return {{"foot_skate_mps", plausibility.foot_skate_mps},
          {"penetration_mean_m", plausibility.penetration_mean_m},
          {"penetration_max_m", plausibility.penetration_max_m},
          {"float_mean_m", plausibility.float_mean_m},
          {"self_penetration_max_m", plausibility.self_penetration_max_m},
          {"acceleration_rms_mps2", plausibility.acceleration_rms_mps2},
          {"jerk_rms_mps3", plausibility.jerk_rms_mps3}};
}

StatusOr<Plausibility> AssessPlausibility(const Clip& clip, const JointRoles& roles,
                                          const PlausibilityConfig& config) {
  POISE_RETURN_IF_ERROR(base::CheckRanges(PlausibilityConfig(config).Fields()));
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  if (clip.num_frames() < kFewestFrames) {
    return base::FailedPrecondition(
        "CLIP_TOO_SHORT", "clip",
        fmt::format("clip '{}' has {} frames, plausibility needs at least {}", clip.name(),
                    clip.num_frames(), kFewestFrames));
  }
  thread_local Workspace workspace;
  WorldPoses& world = workspace.world;
  PlacedBodies& bodies = workspace.bodies;
  ForwardKinematics(clip, 0, clip.num_frames(), world);
  const Skeleton& skeleton = *clip.skeleton();
  POISE_ASSIGN_OR_RETURN(const BodyShapes shapes,
                         MakeBodyShapes(skeleton, roles, EstimateSoles(skeleton, roles, world)));
  PlaceBodies(shapes, world, bodies);
  const FloorContact contact = MeasureFloorContact(bodies, clip.frame_rate(), config);

  Plausibility plausibility;
  plausibility.foot_skate_mps = contact.foot_skate_mps;
  plausibility.penetration_mean_m = contact.penetration_mean_m;
  plausibility.penetration_max_m = contact.penetration_max_m;
  plausibility.float_mean_m = contact.float_mean_m;
  plausibility.self_penetration_max_m = WorstSelfPenetration(shapes, bodies);
  plausibility.acceleration_rms_mps2 = AccelerationRms(world, clip.frame_rate());
  plausibility.jerk_rms_mps3 = JerkRms(world, clip.frame_rate());
  workspace.Trim();
  return plausibility;
}

}  // namespace poise::motion
