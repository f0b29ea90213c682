#include "core/motion/editing/retarget.h"

#include <algorithm>
#include <cmath>

#include "core/motion/editing/joint_correspondence.h"
#include "core/motion/kinematics/sole_estimate.h"
#include "core/motion/rest_pose.h"

namespace poise::motion {
namespace {

using enum JointRole;

// Height of the lowest point of both feet, per frame.
std::vector<double> LowestFootPoints(const Clip& clip, const JointRoles& roles) {
  const WorldPoses world = ForwardKinematics(clip);
  const Skeleton& skeleton = *clip.skeleton();
  const BodyShapes shapes = *MakeBodyShapes(skeleton, roles, EstimateSoles(skeleton, roles, world));
  std::vector<double> lowest;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    double height = HUGE_VAL;
    for (const JointRole ankle : {kRightAnkle, kLeftAnkle}) {
      const BodyShape& foot = shapes[static_cast<int>(ankle)];
      const math::Mat3 turn =
          (world.rotation(frame, foot.joint) * foot.orientation).toRotationMatrix();
      height = std::min(height, world.Point(frame, foot.joint, foot.center).y() -
                                    turn.row(1).cwiseAbs().dot(foot.half_extents));
    }
    lowest.push_back(height);
  }
  return lowest;
}

// Moves the whole clip up or down so that its feet are as high as the source's, scaled.
void MatchFeet(const Clip& source, const JointRoles& roles, double scale,
               const JointRoles& target_roles, Clip& clip) {
  const std::vector<double> wanted = LowestFootPoints(source, roles);
  std::vector<double> lift = LowestFootPoints(clip, target_roles);
  for (size_t i = 0; i < lift.size(); ++i) lift[i] = scale * wanted[i] - lift[i];
  const auto median = lift.begin() + lift.size() / 2;
  std::nth_element(lift.begin(), median, lift.end());
  for (int frame = 0; frame < clip.num_frames(); ++frame) clip.root_position(frame).y() += *median;
}

// Joint rotations of one frame of the target, and where its pelvis lies from its root.
Vec3 PoseTarget(const WorldPoses& source, int frame, const Skeleton& target, int pelvis,
                const std::vector<DrivingJoint>& driving, std::vector<Quat>& rotations) {
  std::vector<Quat> world(target.num_joints());
  std::vector<Vec3> from_root(target.num_joints(), Vec3::Zero());
  for (int j = 0; j < target.num_joints(); ++j) {
    const int parent = target.parent(j);
    const Quat parent_rotation = parent < 0 ? Quat::Identity() : world[parent];
    world[j] = driving[j].source < 0
                   ? parent_rotation
                   : source.rotation(frame, driving[j].source) * driving[j].source_from_target;
    if (parent >= 0) from_root[j] = from_root[parent] + world[parent] * target.joint(j).offset;
    rotations.push_back((parent_rotation.conjugate() * world[j]).normalized());
  }
  return from_root[pelvis];
}

}  // namespace

StatusOr<Clip> Retarget(const Clip& clip, const JointRoles& roles, SkeletonPtr target,
                        const JointRoles& target_roles, const RetargetOptions& options) {
  POISE_RETURN_IF_ERROR(base::Annotate(roles.RequireComplete(), "source skeleton"));
  POISE_RETURN_IF_ERROR(base::Annotate(target_roles.RequireComplete(), "target skeleton"));
  const double source_leg = LegLength(*clip.skeleton(), roles);
  const double target_leg = LegLength(*target, target_roles);
  if (!(source_leg > 0.01 && target_leg > 0.01)) {
    return base::FailedPrecondition("DEGENERATE_SKELETON", "skeleton",
                                    "a leg has no length: retargeting scales by leg length");
  }
  const double scale = target_leg / source_leg;
  const std::vector<DrivingJoint> driving = FindDrivingJoints(
      {*clip.skeleton(), roles, &clip}, {*target, target_roles, options.target_reference});
  const WorldPoses source = ForwardKinematics(clip);
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  rotations.reserve(static_cast<size_t>(clip.num_frames()) * target->num_joints());
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    const Vec3 pelvis_from_root =
        PoseTarget(source, frame, *target, target_roles.joint(kPelvis), driving, rotations);
    positions.push_back(scale * source.position(frame, roles.joint(kPelvis)) - pelvis_from_root);
  }
  POISE_ASSIGN_OR_RETURN(Clip out, Clip::Create(clip.name(), std::move(target), clip.frame_rate(),
                                                std::move(positions), std::move(rotations)));
  MatchFeet(clip, roles, scale, target_roles, out);
  return out;
}

}  // namespace poise::motion
