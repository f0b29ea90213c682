#include "core/motion/editing/reduce.h"

#include <fmt/format.h>

#include <array>

#include "core/motion/body_shapes.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/rest_pose.h"

namespace poise::motion {
namespace {

using enum JointRole;

// Index of the nearest kept ancestor per kept joint; -1 for the pelvis.
StatusOr<std::array<int, kNumRequiredRoles>> KeptParents(const Skeleton& skeleton,
                                                         const JointRoles& roles) {
  std::array<int, kNumRequiredRoles> parents;
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    parents[i] = -1;
    const int joint = roles.joint(static_cast<JointRole>(i));
    for (int up = skeleton.parent(joint); up >= 0 && parents[i] < 0; up = skeleton.parent(up)) {
      const auto role = roles.role(up);
      if (role && static_cast<int>(*role) < kNumRequiredRoles) parents[i] = static_cast<int>(*role);
    }
    if ((i == 0) == (parents[i] < 0) && parents[i] < i) continue;
    return base::FailedPrecondition(
        "UNUSUAL_HIERARCHY", "skeleton",
        fmt::format("joint '{}' ({}) does not hang below the joint of an earlier role",
                    skeleton.joint(joint).name, RoleName(static_cast<JointRole>(i))));
  }
  return parents;
}

// The tip of a kept joint that no kept joint hangs off.
std::optional<Vec3> TipOf(const Skeleton& skeleton, const JointRoles& roles, JointRole role) {
  const int joint = roles.joint(role);
  if (role == kLeftAnkle || role == kRightAnkle) return ToeOffset(skeleton, roles, role);
  if (role == kNeck && roles.has(kHead)) return RestVector(skeleton, roles, kNeck, kHead);
  if (skeleton.joint(joint).end_site) return skeleton.joint(joint).end_site;
  if (!skeleton.children(joint).empty()) return skeleton.joint(skeleton.children(joint)[0]).offset;
  return std::nullopt;
}

StatusOr<SkeletonPtr> ReducedSkeleton(const Skeleton& skeleton, const JointRoles& roles,
                                      const std::array<int, kNumRequiredRoles>& parents) {
  std::vector<Joint> joints;
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    const auto role = static_cast<JointRole>(i);
    Joint joint{skeleton.joint(roles.joint(role)).name, parents[i], Vec3::Zero(), {}};
    if (i > 0) {
      joint.offset = RestVector(skeleton, roles, static_cast<JointRole>(parents[i]), role);
      joints[parents[i]].end_site.reset();
    }
    joint.end_site = TipOf(skeleton, roles, role);
    joints.push_back(std::move(joint));
  }
  return Skeleton::Create(std::move(joints));
}

}  // namespace

StatusOr<Clip> ReduceToRoles(const Clip& clip, const JointRoles& roles, ReductionMode mode) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  const Skeleton& skeleton = *clip.skeleton();
  POISE_ASSIGN_OR_RETURN(const auto parents, KeptParents(skeleton, roles));
  POISE_ASSIGN_OR_RETURN(SkeletonPtr reduced, ReducedSkeleton(skeleton, roles, parents));
  const WorldPoses world = ForwardKinematics(clip);
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    positions.push_back(world.position(frame, roles.joint(kPelvis)));
    for (int i = 0; i < kNumRequiredRoles; ++i) {
      const int joint = roles.joint(static_cast<JointRole>(i));
      if (parents[i] < 0) {
        rotations.push_back(world.rotation(frame, joint));
        continue;
      }
      Quat local = clip.rotation(frame, joint);
      const int kept = roles.joint(static_cast<JointRole>(parents[i]));
      for (int up = skeleton.parent(joint); mode == ReductionMode::kComposed && up != kept;
           up = skeleton.parent(up)) {
        local = clip.rotation(frame, up) * local;
      }
      rotations.push_back(local);
    }
  }
  return Clip::Create(clip.name(), std::move(reduced), clip.frame_rate(), std::move(positions),
                      std::move(rotations));
}

StatusOr<JointRoles> ReducedRoles(const Skeleton& reduced) {
  RoleOverrides overrides;
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    overrides[RoleName(static_cast<JointRole>(i))] =
        i < reduced.num_joints() ? reduced.joint(i).name : std::string();
  }
  return JointRoles::Detect(reduced, overrides);
}

StatusOr<Clip> ExpandFromRoles(const Clip& reduced, const Clip& original, const JointRoles& roles) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  const Skeleton& skeleton = *original.skeleton();
  POISE_ASSIGN_OR_RETURN(const auto parents, KeptParents(skeleton, roles));
  if (reduced.num_frames() != original.num_frames() || reduced.num_joints() != kNumRequiredRoles) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "clip",
        fmt::format("clip '{}' has {} frames of {} joints, expected {} of {}", reduced.name(),
                    reduced.num_frames(), reduced.num_joints(), original.num_frames(),
                    kNumRequiredRoles));
  }
  Clip clip = original;
  WorldPoses world;
  const int pelvis = roles.joint(kPelvis);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (int i = 0; i < kNumRequiredRoles; ++i) {
      const int joint = roles.joint(static_cast<JointRole>(i));
      const int kept = parents[i] < 0 ? -1 : roles.joint(static_cast<JointRole>(parents[i]));
      Quat between = Quat::Identity();
      for (int up = skeleton.parent(joint); up != kept; up = skeleton.parent(up)) {
        between = clip.rotation(frame, up) * between;
      }
      clip.rotation(frame, joint) = between.conjugate() * reduced.rotation(frame, i);
    }
    clip.root_position(frame) = reduced.root_position(frame);
    if (skeleton.parent(pelvis) < 0) continue;
    ForwardKinematics(clip, frame, 1, world);
    clip.root_position(frame) += reduced.root_position(frame) - world.position(0, pelvis);
  }
  return clip;
}

}  // namespace poise::motion
