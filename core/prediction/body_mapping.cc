#include "core/prediction/body_mapping.h"

#include "core/motion/editing/joint_correspondence.h"
#include "core/motion/editing/retarget.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/rest_pose.h"

namespace poise::prediction {
namespace {

using motion::Clip;
using motion::JointRoles;
using motion::Quat;
using motion::Skeleton;
using motion::Vec3;

constexpr double kShortBone = 0.01;      // [m] shorter ones have no direction
constexpr double kSameDirection = 0.97;  // cosine of 14 degrees

// Same joints, and frames that mean the same since the bones lie alike in them.
bool BodiesAgree(const Skeleton& a, const Skeleton& b) {
  if (a.num_joints() != b.num_joints()) return false;
  for (int j = 0; j < a.num_joints(); ++j) {
    if (a.joint(j).name != b.joint(j).name || a.parent(j) != b.parent(j)) return false;
    const Vec3 &x = a.joint(j).offset, &y = b.joint(j).offset;
    if (j == 0 || (x.norm() < kShortBone && y.norm() < kShortBone)) continue;
    if (x.dot(y) < kSameDirection * x.norm() * y.norm()) return false;
  }
  return true;
}

std::vector<int> DrivingIndices(const Clip& model, const JointRoles& model_roles,
                                const Clip& source, const JointRoles& roles) {
  std::vector<int> indices;
  for (const motion::DrivingJoint& driving : motion::FindDrivingJoints(
           {*model.skeleton(), model_roles, &model}, {*source.skeleton(), roles, &source})) {
    indices.push_back(driving.source);
  }
  return indices;
}

}  // namespace

StatusOr<BodyMapping> BodyMapping::Create(Clip source, const JointRoles& roles,
                                          const motion::SkeletonPtr& model) {
  if (BodiesAgree(*source.skeleton(), *model)) {
    POISE_ASSIGN_OR_RETURN(
        Clip same, Clip::Create(source.name(), model, source.frame_rate(),
                                {source.root_positions().begin(), source.root_positions().end()},
                                {source.rotations().begin(), source.rotations().end()}));
    return BodyMapping(std::move(source), std::move(same), {}, 1);
  }
  POISE_ASSIGN_OR_RETURN(const JointRoles model_roles, JointRoles::Detect(*model));
  POISE_ASSIGN_OR_RETURN(Clip on_model, motion::Retarget(source, roles, model, model_roles));
  std::vector<int> driving = DrivingIndices(on_model, model_roles, source, roles);
  const double scale =
      motion::LegLength(*source.skeleton(), roles) / motion::LegLength(*model, model_roles);
  return BodyMapping(std::move(source), std::move(on_model), std::move(driving), scale);
}

StatusOr<Clip> BodyMapping::Back(const Clip& future) const {
  if (driving_.empty()) {
    return Clip::Create(source_.name(), source_.skeleton(), future.frame_rate(),
                        {future.root_positions().begin(), future.root_positions().end()},
                        {future.rotations().begin(), future.rotations().end()});
  }
  const Skeleton& skeleton = *source_.skeleton();
  const int joints = skeleton.num_joints();
  const int last = source_.num_frames() - 1;
  motion::WorldPoses model_last, source_last;
  motion::ForwardKinematics(on_model_, on_model_.num_frames() - 1, 1, model_last);
  motion::ForwardKinematics(source_, last, 1, source_last);
  const motion::WorldPoses world = motion::ForwardKinematics(future);
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  rotations.reserve(static_cast<size_t>(future.num_frames()) * joints);
  std::vector<Quat> turned(joints);
  for (int frame = 0; frame < future.num_frames(); ++frame) {
    positions.push_back(source_.root_position(last) +
                        scale_ * (world.position(frame, 0) - model_last.position(0, 0)));
    for (int j = 0; j < joints; ++j) {
      const Quat parent = j == 0 ? Quat::Identity() : turned[skeleton.parent(j)];
      const int d = driving_[j];
      turned[j] = d < 0 ? parent * source_.rotation(last, j)
                        : world.rotation(frame, d) * model_last.rotation(0, d).conjugate() *
                              source_last.rotation(0, j);
      rotations.push_back((parent.conjugate() * turned[j]).normalized());
    }
  }
  return Clip::Create(source_.name(), source_.skeleton(), future.frame_rate(), std::move(positions),
                      std::move(rotations));
}

}  // namespace poise::prediction
