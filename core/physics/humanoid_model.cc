#include "core/physics/humanoid_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/motion/kinematics/sole_estimate.h"
#include "core/motion/rest_pose.h"

namespace poise::physics {
namespace {

using motion::BodyShape;
using motion::JointRole;
using motion::RestVector;
using motion::ShapeKind;
using enum motion::JointRole;

constexpr double kReferenceMass = 45;                            // [kg]
constexpr double kReferenceFoot[] = {0.13275, 0.04125, 0.0675};  // [m] length, thickness, width

// Numbers of one body and its joint (MotionAug sec. 4.2, 4.3), of the reference's 45 kg.
struct Plan {
  int parent;
  double mass;          // [kg]
  double stiffness;     // [N m/rad]
  double damping;       // [N m s/rad]
  double torque_limit;  // [N m] DeepMimic's
  double weight;        // in rewards
};
constexpr Plan kHip = {0, 4.5, 500, 50, 200, 0.5}, kKnee = {-1, 3, 500, 50, 150, 0.3},
               kAnkle = {-1, 1, 400, 40, 90, 0.2}, kShoulder = {2, 1.5, 400, 40, 100, 0.3},
               kElbow = {-1, 1, 300, 30, 60, 0.2}, kWrist = {-1, 0.5, 0, 0, 20, 0.1};
constexpr Plan On(int parent, Plan plan) {
  plan.parent = parent;
  return plan;
}
constexpr std::array<Plan, kMaxBodies> kPlans = {{
    {-1, 6, 0, 0, 0, 1.0},        // pelvis
    {0, 7, 1000, 100, 200, 0.5},  // spine
    {1, 7, 1000, 100, 200, 0.5},  // chest
    {2, 2, 100, 10, 50, 0.3},     // neck with head
    kHip,
    On(4, kKnee),
    On(5, kAnkle),
    kShoulder,
    On(7, kElbow),
    On(8, kWrist),
    kHip,
    On(10, kKnee),
    On(11, kAnkle),
    kShoulder,
    On(13, kElbow),
    On(14, kWrist),
}};
static_assert(motion::kNumRequiredRoles == kMaxBodies);

bool IsWrist(int body) {
  return body == static_cast<int>(kRightWrist) || body == static_cast<int>(kLeftWrist);
}

// Bullet's local inertia of the shape, which for a capsule is that of its bounding box.
Vec3 PrincipalInertia(const BodyShape& shape, double mass) {
  if (shape.kind == ShapeKind::kSphere) {
    return Vec3::Constant(0.4 * mass * shape.radius * shape.radius);
  }
  Vec3 half = shape.half_extents;
  if (shape.kind == ShapeKind::kCapsule) {
    half = Vec3(shape.radius, shape.radius + shape.half_length, shape.radius);
  }
  const Vec3 square = half.cwiseProduct(half);
  return mass / 3 * Vec3(square.y() + square.z(), square.x() + square.z(), square.x() + square.y());
}

void CopyShape(const BodyShape& shape, Body& body) {
  const math::Mat3 axes = shape.orientation.toRotationMatrix();
  const math::Mat3 inertia =
      axes * PrincipalInertia(shape, body.mass).asDiagonal() * axes.transpose();
  Eigen::Map<math::Mat3>(body.inertia) = inertia;
  Eigen::Map<math::Mat3>(body.shape_axes) = axes;
  Eigen::Map<Vec3>(body.center_of_mass) = shape.center;
  Eigen::Map<Vec3>(body.shape_center) = shape.center;
  Eigen::Map<Vec3>(body.half_extents) = shape.half_extents;
  body.radius = shape.radius;
  body.half_length = shape.half_length;
  body.geometry = shape.kind == ShapeKind::kSphere    ? Geometry::kSphere
                  : shape.kind == ShapeKind::kCapsule ? Geometry::kCapsule
                                                      : Geometry::kBox;
}

// The reference's foot: a small box half way to the toes.
void MakeReferenceFoot(const motion::Skeleton& skeleton, const motion::JointRoles& roles,
                       BodyShape& foot) {
  const double scale = motion::BodyScale(skeleton, roles);
  foot.half_extents = scale / 2 * Vec3(kReferenceFoot[0], kReferenceFoot[1], kReferenceFoot[2]);
  if (const auto toe = motion::ToeOffset(skeleton, roles, foot.role)) foot.center = *toe / 2;
}

Status CheckHierarchy(const motion::Skeleton& skeleton, const motion::JointRoles& roles) {
  for (int i = 1; i < kMaxBodies; ++i) {
    const auto role = static_cast<JointRole>(i), above = static_cast<JointRole>(kPlans[i].parent);
    const std::vector<int> chain = skeleton.ChainToRoot(roles.joint(role));
    if (std::count(chain.begin() + 1, chain.end(), roles.joint(above)) > 0) continue;
    return base::FailedPrecondition(
        "UNUSUAL_HIERARCHY", "skeleton",
        fmt::format("joint '{}' ({}) does not hang below joint '{}' ({})",
                    skeleton.joint(roles.joint(role)).name, motion::RoleName(role),
                    skeleton.joint(roles.joint(above)).name, motion::RoleName(above)));
  }
  return absl::OkStatus();
}

Articulation MakeArticulation(const motion::Skeleton& skeleton, const motion::JointRoles& roles,
                              const motion::BodyShapes& shapes, const HumanoidConfig& config) {
  const double heavier = config.body_mass_kg / kReferenceMass;
  Articulation tree;
  tree.num_bodies = kMaxBodies;
  for (int i = 0; i < kMaxBodies; ++i) {
    const Plan& plan = kPlans[i];
    Body& body = tree.bodies[i];
    body.parent = plan.parent;
    body.rigid_joint = config.fixed_wrists && IsWrist(i);
    body.mass = heavier * plan.mass;
    body.stiffness = heavier * plan.stiffness * config.stiffness_factor;
    body.damping = heavier * plan.damping * config.damping_factor;
    body.torque_limit = heavier * plan.torque_limit * config.torque_limit_factor;
    if (i > 0) {
      Eigen::Map<Vec3>(body.offset) = RestVector(
          skeleton, roles, static_cast<JointRole>(plan.parent), static_cast<JointRole>(i));
    }
    CopyShape(shapes[i], body);
  }
  return tree;
}

// Axes of a foot by its own bones: along the toes, across them in the plane of the shin, and at
// right angles to both; the last points outwards on one side and inwards on the other.
std::optional<math::Mat3> FootAxes(const motion::Skeleton& skeleton,
                                   const motion::JointRoles& roles, JointRole knee,
                                   JointRole ankle) {
  const auto toe = motion::ToeOffset(skeleton, roles, ankle);
  const Vec3 shin = RestVector(skeleton, roles, knee, ankle);
  if (!toe || toe->cross(shin).norm() < 0.2 * toe->norm() * shin.norm()) return std::nullopt;
  math::Mat3 axes;
  axes.col(0) = toe->normalized();
  axes.col(2) = shin.cross(*toe).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

}  // namespace

ResidualGains ResidualGains::Scaled(double factor) const {
  return {factor * stiffness, factor * damping, factor * angular_stiffness,
          factor * angular_damping};
}

motion::Soles SymmetricSoles(const motion::Skeleton& skeleton, const motion::JointRoles& roles,
                             const motion::Soles& soles) {
  const auto right = FootAxes(skeleton, roles, kRightKnee, kRightAnkle);
  const auto left = FootAxes(skeleton, roles, kLeftKnee, kLeftAnkle);
  if (!right || !left) return soles;
  const Vec3 mirror(1, 1, -1);
  const Vec3 mean =
      right->transpose() * soles.right.up + mirror.cwiseProduct(left->transpose() * soles.left.up);
  const auto sole = [&](const math::Mat3& axes, const Vec3& up) {
    return motion::MakeSole(axes * up, axes.col(0));
  };
  const auto new_right = sole(*right, mean), new_left = sole(*left, mirror.cwiseProduct(mean));
  if (!new_right || !new_left) return soles;
  return {.right = *new_right, .left = *new_left};
}

StatusOr<HumanoidModelPtr> HumanoidModel::Create(const motion::Skeleton& skeleton,
                                                 const motion::JointRoles& roles,
                                                 const motion::Soles& soles,
                                                 const HumanoidConfig& config) {
  HumanoidConfig checked = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  POISE_RETURN_IF_ERROR(CheckHierarchy(skeleton, roles));
  std::shared_ptr<HumanoidModel> model(new HumanoidModel);
  POISE_ASSIGN_OR_RETURN(model->shapes_, motion::MakeBodyShapes(skeleton, roles, soles));
  if (config.foot_box == "reference") {
    for (const JointRole ankle : {kRightAnkle, kLeftAnkle}) {
      MakeReferenceFoot(skeleton, roles, model->shapes_[static_cast<int>(ankle)]);
    }
  }
  model->config_ = config;
  model->articulation_ = MakeArticulation(skeleton, roles, model->shapes_, config);
  for (int i = 0; i < kMaxBodies; ++i) {
    model->joint_weights_[i] = config.fixed_wrists && IsWrist(i) ? 0 : kPlans[i].weight;
  }
  model->residual_gains_ = ResidualGains{}.Scaled(config.body_mass_kg / kReferenceMass);
  return model;
}

StatusOr<HumanoidModelPtr> HumanoidModel::Create(const motion::Clip& clip,
                                                 const motion::JointRoles& roles,
                                                 const HumanoidConfig& config) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  const motion::Skeleton& skeleton = *clip.skeleton();
  const motion::Soles soles =
      motion::EstimateSoles(skeleton, roles, motion::ForwardKinematics(clip));
  return Create(skeleton, roles, SymmetricSoles(skeleton, roles, soles), config);
}

double HumanoidModel::total_mass() const {
  double sum = 0;
  for (int i = 0; i < articulation_.num_bodies; ++i) sum += articulation_.bodies[i].mass;
  return sum;
}

int HumanoidModel::degrees_of_freedom() const {
  int count = articulation_.num_speeds();
  for (int i = 0; i < articulation_.num_bodies; ++i) {
    if (articulation_.bodies[i].rigid_joint) count -= 3;
  }
  return count;
}

}  // namespace poise::physics
