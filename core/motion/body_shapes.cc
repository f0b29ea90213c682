#include "core/motion/body_shapes.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rest_pose.h"

namespace poise::motion {
namespace {

using enum JointRole;

// Reference humanoid (MotionAug sec. 1.6, 4.2): both legs and both arms, hip to ankle and shoulder
// to wrist, in metres.
constexpr double kReferenceLimbs =
    0.3717 + 0.3755 + 0.3579 + 0.3746 + 0.2621 + 0.1722 + 0.2491 + 0.1742;
constexpr double kFootThickness = 0.04125, kFootWidth = 0.0675;  // [m] of the reference humanoid
constexpr double kHeelBehindAnkle = 0.35;  // parts of the length ankle to ball
constexpr double kTipBeyondBall = 0.35;    // where the toes have no end site
constexpr double kFootPerShin = 0.33;      // ankle to ball, where there is no toe joint
constexpr double kAnkleHeightPerShin = 0.18;

// What each body is: diameter [m] and, for capsules, the part of the bone that the cylinder covers.
struct Plan {
  JointRole role;
  int parent;
  ShapeKind kind;
  double diameter;
  double covered;
  JointRole far_end;  // the joint at the bone's other end
};
constexpr auto kSphere = ShapeKind::kSphere;
constexpr auto kCapsule = ShapeKind::kCapsule;
constexpr auto kBox = ShapeKind::kBox;
constexpr std::array<Plan, kNumRequiredRoles> kPlans = {{
    {kPelvis, -1, kSphere, 0.135, 0, kSpine},
    {kSpine, 0, kSphere, 0.165, 0, kChest},
    {kChest, 1, kSphere, 0.165, 0, kNeck},
    {kNeck, 2, kSphere, 0.15375, 0, kHead},
    {kRightHip, 0, kCapsule, 0.0825, 0.617, kRightKnee},
    {kRightKnee, 4, kCapsule, 0.075, 0.620, kRightAnkle},
    {kRightAnkle, 5, kBox, 0, 0, kRightToe},
    {kRightShoulder, 2, kCapsule, 0.0675, 0.528, kRightElbow},
    {kRightElbow, 7, kCapsule, 0.06, 0.585, kRightWrist},
    {kRightWrist, 8, kSphere, 0.06, 0, kRightWrist},
    {kLeftHip, 0, kCapsule, 0.0825, 0.617, kLeftKnee},
    {kLeftKnee, 10, kCapsule, 0.075, 0.620, kLeftAnkle},
    {kLeftAnkle, 11, kBox, 0, 0, kLeftToe},
    {kLeftShoulder, 2, kCapsule, 0.0675, 0.528, kLeftElbow},
    {kLeftElbow, 13, kCapsule, 0.06, 0.585, kLeftWrist},
    {kLeftWrist, 14, kSphere, 0.06, 0, kLeftWrist},
}};
constexpr double kHeadAboveNeck = 0.0875;  // [m] centre of the head, of the reference humanoid

// Where the head is from the neck: towards the head joint, else the neck's end site or first child,
// else on from chest to neck.
Vec3 HeadDirection(const Skeleton& skeleton, const JointRoles& roles) {
  const int neck = roles.joint(kNeck);
  Vec3 direction = Vec3::Zero();
  if (roles.has(kHead)) direction = RestVector(skeleton, neck, roles.joint(kHead));
  if (direction.isZero(1e-6) && skeleton.joint(neck).end_site) {
    direction = *skeleton.joint(neck).end_site;
  }
  if (direction.isZero(1e-6) && !skeleton.children(neck).empty()) {
    direction = skeleton.joint(skeleton.children(neck)[0]).offset;
  }
  if (direction.isZero(1e-6)) direction = RestVector(skeleton, roles, kChest, kNeck);
  if (direction.isZero(1e-6)) direction = Vec3::UnitY();
  return direction.normalized();
}

// From the toe joint on to the tip of the foot, in the ankle's frame; zero when unknown.
Vec3 TipBeyondToe(const Skeleton& skeleton, const JointRoles& roles, JointRole toe) {
  if (!roles.has(toe)) return Vec3::Zero();
  const Joint& joint = skeleton.joint(roles.joint(toe));
  return joint.end_site.value_or(Vec3::Zero());
}

void PlaceFoot(const Skeleton& skeleton, const JointRoles& roles, const Sole& sole, double scale,
               BodyShape& foot) {
  const bool right = foot.role == kRightAnkle;
  const double shin = RestVector(skeleton, roles, right ? kRightKnee : kLeftKnee, foot.role).norm();
  const double thickness = scale * kFootThickness;
  double ball = kFootPerShin * shin;
  double depth = kAnkleHeightPerShin * shin;
  double tip = ball * (1 + kTipBeyondBall);
  if (const auto toe = ToeOffset(skeleton, roles, foot.role)) {
    ball = std::max(toe->dot(sole.forward), 0.0);
    depth = std::max(-toe->dot(sole.up), 0.0) + thickness / 2;
    const Vec3 beyond = TipBeyondToe(skeleton, roles, right ? kRightToe : kLeftToe);
    tip = ball + (beyond.norm() > 0.01 ? beyond.norm() : kTipBeyondBall * ball);
  }
  const double heel = -kHeelBehindAnkle * ball;
  foot.half_extents = Vec3((tip - heel) / 2, thickness / 2, scale * kFootWidth / 2);
  foot.center = (tip + heel) / 2 * sole.forward - (depth - thickness / 2) * sole.up;
  math::Mat3 axes;
  axes << sole.forward, sole.up, sole.forward.cross(sole.up);
  foot.orientation = Quat(axes);
}

}  // namespace

std::optional<Vec3> ToeOffset(const Skeleton& skeleton, const JointRoles& roles, JointRole ankle) {
  const JointRole toe = ankle == kRightAnkle ? kRightToe : kLeftToe;
  std::optional<Vec3> offset = skeleton.joint(roles.joint(ankle)).end_site;
  if (roles.has(toe)) offset = RestVector(skeleton, roles, ankle, toe);
  if (offset && offset->norm() < 0.01) offset.reset();
  return offset;
}

std::optional<Sole> MakeSole(const Vec3& up, const Vec3& towards_toes) {
  const Vec3 normal = up.normalized();
  const Vec3 forward = towards_toes - normal * normal.dot(towards_toes);
  if (!(up.norm() > 0 && forward.norm() > 0.3 * towards_toes.norm())) return std::nullopt;
  return Sole{normal, forward.normalized()};
}

std::optional<Soles> SolesOfRestPose(const Skeleton& skeleton, const JointRoles& roles) {
  if (!RestPoseStands(skeleton, roles)) return std::nullopt;
  const Vec3 across = RestVector(skeleton, roles, kPelvis, kLeftHip) -
                      RestVector(skeleton, roles, kPelvis, kRightHip);
  const auto sole = [&](JointRole knee, JointRole ankle) {
    const Vec3 up = -RestVector(skeleton, roles, knee, ankle);
    // Left of the body cross up is forward.
    return MakeSole(up, ToeOffset(skeleton, roles, ankle).value_or(across.cross(up)));
  };
  const auto right = sole(kRightKnee, kRightAnkle);
  const auto left = sole(kLeftKnee, kLeftAnkle);
  if (!right || !left) return std::nullopt;
  return Soles{*right, *left};
}

double BodyScale(const Skeleton& skeleton, const JointRoles& roles) {
  double limbs = 0;
  for (const Plan& plan : kPlans) {
    if (plan.kind == ShapeKind::kCapsule) {
      limbs += RestVector(skeleton, roles, plan.role, plan.far_end).norm();
    }
  }
  return limbs / kReferenceLimbs;
}

StatusOr<BodyShapes> MakeBodyShapes(const Skeleton& skeleton, const JointRoles& roles,
                                    const Soles& soles) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  const double scale = BodyScale(skeleton, roles);
  BodyShapes shapes;
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    const Plan& plan = kPlans[i];
    BodyShape& shape = shapes[i];
    shape.role = plan.role;
    shape.joint = roles.joint(plan.role);
    shape.parent = plan.parent;
    shape.kind = plan.kind;
    shape.radius = scale * plan.diameter / 2;
    if (plan.kind == ShapeKind::kCapsule) {
      const Vec3 bone = RestVector(skeleton, roles, plan.role, plan.far_end);
      shape.center = bone / 2;
      shape.half_length = plan.covered * bone.norm() / 2;
      shape.orientation = math::SwingBetween(Vec3::UnitY(), bone);
    } else if (plan.kind == ShapeKind::kBox) {
      PlaceFoot(skeleton, roles, plan.role == kRightAnkle ? soles.right : soles.left, scale, shape);
    } else if (plan.role == kNeck) {
      shape.center = scale * kHeadAboveNeck * HeadDirection(skeleton, roles);
    }
  }
  return shapes;
}

}  // namespace poise::motion
