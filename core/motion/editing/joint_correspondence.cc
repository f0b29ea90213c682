#include "core/motion/editing/joint_correspondence.h"

#include <algorithm>
#include <array>
#include <optional>

#include "absl/strings/ascii.h"
#include "core/motion/body_shapes.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/rest_pose.h"

namespace poise::motion {
namespace {

using enum JointRole;
using math::Mat3;

constexpr int kSampledFrames = 64;
constexpr double kShortBone = 0.01;        // [m] shorter ones have no direction
constexpr double kSameDirection = 0.0873;  // [rad] 5 degrees

// The next joint along a limb, whose bone a role turns.
struct Bone {
  JointRole from, to;
};
constexpr std::array<Bone, 13> kBones = {{{kSpine, kChest},
                                          {kNeck, kHead},
                                          {kRightHip, kRightKnee},
                                          {kRightKnee, kRightAnkle},
                                          {kRightCollar, kRightShoulder},
                                          {kRightShoulder, kRightElbow},
                                          {kRightElbow, kRightWrist},
                                          {kLeftHip, kLeftKnee},
                                          {kLeftKnee, kLeftAnkle},
                                          {kLeftCollar, kLeftShoulder},
                                          {kLeftShoulder, kLeftElbow},
                                          {kLeftElbow, kLeftWrist},
                                          {kChest, kNeck}}};

// Columns: left, up, forward. Exact in `left`; nothing where the two are almost parallel or short.
std::optional<Mat3> AnatomicalFrame(const Vec3& left, const Vec3& up) {
  const Vec3 forward = left.cross(up);
  if (left.norm() < kShortBone || forward.norm() < 0.1 * left.norm() * up.norm() ||
      up.norm() < kShortBone) {
    return std::nullopt;
  }
  Mat3 frame;
  frame.col(0) = left.normalized();
  frame.col(2) = forward.normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

// How each joint is turned against the body's anatomical frame while it stands: by the rest pose,
// or by the average over a motion.
std::vector<Quat> StandingFrames(const RetargetBody& body) {
  const Skeleton& skeleton = body.skeleton;
  const JointRoles& roles = body.roles;
  const int joints = skeleton.num_joints();
  if (RestPoseStands(skeleton, roles) || body.motion == nullptr) {
    const auto frame = AnatomicalFrame(RestVector(skeleton, roles, kPelvis, kLeftHip) -
                                           RestVector(skeleton, roles, kPelvis, kRightHip),
                                       RestVector(skeleton, roles, kPelvis, kNeck));
    return std::vector<Quat>(joints, Quat(frame.value_or(Mat3::Identity())).conjugate());
  }
  std::vector<Eigen::Vector4d> sums(joints, Eigen::Vector4d::Zero());
  const int step = std::max(1, body.motion->num_frames() / kSampledFrames);
  WorldPoses world;
  for (int frame = 0; frame < body.motion->num_frames(); frame += step) {
    ForwardKinematics(*body.motion, frame, 1, world);
    const auto at = [&](JointRole role) { return world.position(0, roles.joint(role)); };
    const auto anatomy = AnatomicalFrame(at(kLeftHip) - at(kRightHip), at(kNeck) - at(kPelvis));
    if (!anatomy) continue;
    const Quat anatomy_from_world = Quat(*anatomy).conjugate();
    for (int j = 0; j < joints; ++j) {
      const Eigen::Vector4d turn = (anatomy_from_world * world.rotation(0, j)).coeffs();
      sums[j] += turn.dot(sums[j]) < 0 ? Eigen::Vector4d(-turn) : turn;
    }
  }
  std::vector<Quat> frames;
  for (const Eigen::Vector4d& sum : sums) {
    frames.push_back(sum.norm() > 1e-6 ? Quat(Eigen::Vector4d(sum.normalized()))
                                       : Quat::Identity());
  }
  return frames;
}

// The bone that a role's joint turns, in the joint's frame; zero when there is none.
Vec3 BoneOf(const RetargetBody& body, JointRole role) {
  if (role == kLeftAnkle || role == kRightAnkle) {
    return ToeOffset(body.skeleton, body.roles, role).value_or(Vec3::Zero());
  }
  for (const Bone& bone : kBones) {
    if (bone.from == role) return RestVector(body.skeleton, body.roles, bone.from, bone.to);
  }
  return body.skeleton.joint(body.roles.joint(role)).end_site.value_or(Vec3::Zero());
}

// Left and up of pelvis or chest, in the joint's own frame.
std::pair<Vec3, Vec3> TrunkAxes(const RetargetBody& body, JointRole role) {
  const bool pelvis = role == kPelvis;
  const auto to = [&](JointRole other) {
    return RestVector(body.skeleton, body.roles, role, other);
  };
  return {pelvis ? to(kLeftHip) - to(kRightHip) : to(kLeftShoulder) - to(kRightShoulder),
          pelvis ? to(kSpine) : to(kNeck)};
}

// Turns `start` (source from target) so that the target's bones lie where the source's do.
Quat AlignBones(const RetargetBody& source, const RetargetBody& target, JointRole role,
                const Quat& start) {
  const auto swing = [&](const Vec3& from, const Vec3& to) {
    if (from.norm() < kShortBone || to.norm() < kShortBone) return start;
    return (math::SwingBetween(start * from, to) * start).normalized();
  };
  if (role != kPelvis && role != kChest) return swing(BoneOf(target, role), BoneOf(source, role));
  const auto [source_left, source_up] = TrunkAxes(source, role);
  const auto [target_left, target_up] = TrunkAxes(target, role);
  const auto source_frame = AnatomicalFrame(source_left, source_up);
  const auto target_frame = AnatomicalFrame(target_left, target_up);
  if (!source_frame || !target_frame) return swing(target_left, source_left);
  return Quat(Mat3(*source_frame * target_frame->transpose()));
}

// Same joints by name and parent, and offsets in the same directions: then local frames mean the
// same in both, whatever the rest pose.
bool SameBuild(const Skeleton& a, const Skeleton& b) {
  if (a.num_joints() != b.num_joints()) return false;
  for (int j = 0; j < a.num_joints(); ++j) {
    const Joint &x = a.joint(j), &y = b.joint(j);
    if (x.name != y.name || x.parent != y.parent) return false;
    if (x.offset.norm() < kShortBone || y.offset.norm() < kShortBone) continue;
    if (std::acos(std::clamp(x.offset.normalized().dot(y.offset.normalized()), -1.0, 1.0)) >
        kSameDirection) {
      return false;
    }
  }
  return true;
}

int SourceJoint(const RetargetBody& source, const RetargetBody& target, int joint) {
  if (const auto role = target.roles.role(joint)) return source.roles.joint(*role);
  const std::string name = absl::AsciiStrToLower(target.skeleton.joint(joint).name);
  for (int i = 0; i < source.skeleton.num_joints(); ++i) {
    if (!source.roles.role(i) && absl::AsciiStrToLower(source.skeleton.joint(i).name) == name) {
      return i;
    }
  }
  return -1;
}

}  // namespace

std::vector<DrivingJoint> FindDrivingJoints(const RetargetBody& source,
                                            const RetargetBody& target) {
  const bool same_build = SameBuild(source.skeleton, target.skeleton);
  std::vector<Quat> source_frames, target_frames;
  if (!same_build) {
    source_frames = StandingFrames(source);
    target_frames = StandingFrames(target);
  }
  std::vector<DrivingJoint> driving(target.skeleton.num_joints());
  for (int j = 0; j < target.skeleton.num_joints(); ++j) {
    const int from = SourceJoint(source, target, j);
    if (from < 0) continue;
    driving[j].source = from;
    Quat& turn = driving[j].source_from_target;
    if (!same_build) turn = source_frames[from].conjugate() * target_frames[j];
    if (const auto role = target.roles.role(j)) turn = AlignBones(source, target, *role, turn);
  }
  return driving;
}

}  // namespace poise::motion
