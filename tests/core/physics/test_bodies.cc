#include "tests/core/physics/test_bodies.h"

#include "tests/support/test_clips.h"

namespace poise::physics {

HumanoidModelPtr TestHumanoid(const HumanoidConfig& config) {
  const motion::SkeletonPtr skeleton = testing::Biped();
  const motion::JointRoles roles = *motion::JointRoles::Detect(*skeleton);
  return *HumanoidModel::Create(*skeleton, roles, *motion::SolesOfRestPose(*skeleton, roles),
                                config);
}

State RandomState(const Articulation& tree, base::Random& random, double speed) {
  State state;
  const auto vector = [&](double size) {
    return Vec3(random.Uniform(-size, size), random.Uniform(-size, size),
                random.Uniform(-size, size));
  };
  state.root_position = vector(3) + Vec3(0, 10, 0);
  state.speeds.head<3>() = vector(speed);
  for (int i = 0; i < tree.num_bodies; ++i) {
    if (tree.bodies[i].rigid_joint) continue;
    state.rotations[i] = math::FromRotationVector(vector(i == 0 ? 2 : 0.6));
    state.speeds.segment<3>(SpeedIndex(i)) = vector(speed);
  }
  return state;
}

Articulation Pendulum() {
  Articulation tree;
  tree.num_bodies = 2;
  tree.fixed_base = true;
  for (Body& body : tree.bodies) {
    body.mass = 2;
    Eigen::Map<math::Mat3>(body.inertia) = Vec3(0.02, 0.004, 0.02).asDiagonal();
  }
  tree.bodies[1].parent = 0;
  Eigen::Map<Vec3>(tree.bodies[1].center_of_mass) = Vec3(0, -0.5, 0);
  return tree;
}

}  // namespace poise::physics
