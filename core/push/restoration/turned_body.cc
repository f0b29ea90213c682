#include "core/push/restoration/turned_body.h"

#include <array>
#include <optional>

#include "core/motion/kinematics/forward_kinematics.h"
#include "core/push/standing_person.h"

namespace poise::push {
namespace {

using motion::JointRole;

// The role of each of the 22 joints; joint 2 has none.
constexpr std::array<std::optional<JointRole>, kBodyJoints> kRoles = {
    JointRole::kPelvis,      JointRole::kSpine,         std::nullopt,
    JointRole::kChest,       JointRole::kNeck,          JointRole::kHead,
    JointRole::kRightCollar, JointRole::kRightShoulder, JointRole::kRightElbow,
    JointRole::kRightWrist,  JointRole::kLeftCollar,    JointRole::kLeftShoulder,
    JointRole::kLeftElbow,   JointRole::kLeftWrist,     JointRole::kRightHip,
    JointRole::kRightKnee,   JointRole::kRightAnkle,    JointRole::kRightToe,
    JointRole::kLeftHip,     JointRole::kLeftKnee,      JointRole::kLeftAnkle,
    JointRole::kLeftToe};

// A turn in the ground frame about the world's axes.
math::Quat InWorld(const math::Quat& turn) {
  const Vec3 axis = WorldFromGround(turn.vec());
  return {turn.w(), axis.x(), axis.y(), axis.z()};
}

}  // namespace

BodyShape ShapeOf(const motion::Clip& clip, int frame, const motion::JointRoles& roles) {
  motion::WorldPoses world;
  motion::ForwardKinematics(clip, frame, 1, world);
  const motion::Clip& average = StandingPerson();
  const motion::WorldPoses usual = motion::ForwardKinematics(average);
  const Vec3 pelvis = world.position(0, roles.joint(JointRole::kPelvis));
  BodyShape shape;
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    const auto role = kRoles[joint];
    if (role && roles.has(*role)) {
      shape[joint] = GroundFromWorld(world.position(0, roles.joint(*role)) - pelvis);
    } else {
      const int parent = kBodyParents[joint];
      shape[joint] =
          shape[parent] + GroundFromWorld(usual.position(0, joint) - usual.position(0, parent));
    }
  }
  // Between its neighbours.
  shape[2] = (shape[1] + shape[3]) / 2;
  return shape;
}

TurnedBody::TurnedBody(const motion::Clip& standing, const motion::JointRoles& roles)
    : skeleton_(standing.skeleton()), body_joints_(standing.num_joints(), kPelvis) {
  motion::WorldPoses world;
  motion::ForwardKinematics(standing, 0, 1, world);
  standing_ = world.rotations;
  from_pelvis_ = world.position(0, 0) - world.position(0, roles.joint(JointRole::kPelvis));
  for (int joint = 0; joint < skeleton_->num_joints(); ++joint) {
    if (joint > 0) body_joints_[joint] = body_joints_[skeleton_->parent(joint)];
    for (int body = 0; body < kBodyJoints; ++body) {
      if (kRoles[body] && roles.joint(*kRoles[body]) == joint) body_joints_[joint] = body;
    }
  }
}

std::vector<math::Quat> TurnedBody::Rotations(const BodyTurns& turns) const {
  std::vector<math::Quat> world(standing_.size()), local(standing_.size());
  for (size_t joint = 0; joint < standing_.size(); ++joint) {
    world[joint] = InWorld(turns[body_joints_[joint]]) * standing_[joint];
    const int parent = skeleton_->parent(static_cast<int>(joint));
    local[joint] = parent < 0 ? world[joint] : world[parent].conjugate() * world[joint];
  }
  return local;
}

Vec3 TurnedBody::RootPosition(const BodyTurns& turns, const Vec3& pelvis) const {
  return pelvis + InWorld(turns[body_joints_[0]]) * from_pelvis_;
}

}  // namespace poise::push
