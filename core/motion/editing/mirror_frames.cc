#include "core/motion/editing/mirror_frames.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::motion {
namespace {

using math::Mat3;

constexpr double kShortBone = 0.02;  // [m] directions of shorter bones say nothing
// Within these angles [rad] two bones count as mirror images: 3 degrees on limbs, where more is a
// rest pose caught from a stance, but 15 on the bones up to hips and shoulders, where it is the
// shape of the body (HDM05's collars differ by 11).
constexpr double kSameLimb = 0.0524;
constexpr double kSameGirdle = 0.262;
constexpr double kCaughtRestPose = 0.785;  // 45 degrees: a stance, feet turned out
constexpr double kLengthRatio = 0.15;      // bones of the two sides may differ by this part
constexpr double kLengthSlack = 0.01;      // [m] and this much
constexpr int kSampledFrames = 64;         // of the clip, for its average pose

// A bone of a joint and the bone of the joint's partner that should be its mirror image.
struct BonePair {
  Vec3 bone;
  Vec3 image;
  double tolerance;  // [rad] within which they are mirror images
};
using BonePairs = std::vector<std::vector<BonePair>>;  // (joints), bones of each

double Angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

Mat3 Reflection(const Vec3& normal) {
  return Mat3::Identity() - 2 * normal * normal.transpose() / normal.squaredNorm();
}

StatusOr<BonePairs> CollectBones(const Skeleton& skeleton, const JointRoles& roles,
                                 std::span<const int> partners) {
  BonePairs bones(skeleton.num_joints());
  std::vector<bool> girdle(skeleton.num_joints(), false);  // up to hips and shoulders
  for (const JointRole role : {JointRole::kLeftHip, JointRole::kRightHip, JointRole::kLeftShoulder,
                               JointRole::kRightShoulder}) {
    for (const int joint : skeleton.ChainToRoot(roles.joint(role))) girdle[joint] = true;
  }
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const auto add = [&](const Vec3& bone, const Vec3& image, double tolerance,
                         const std::string& name) -> Status {
      const double a = bone.norm(), b = image.norm();
      if (std::abs(a - b) > kLengthSlack + kLengthRatio * std::max(a, b)) {
        return base::FailedPrecondition(
            "ASYMMETRIC_SKELETON", "skeleton",
            fmt::format("the bone to '{}' is {:.3f} m long and {:.3f} m on the other side; the "
                        "mirrored motion would not fit this body",
                        name, a, b));
      }
      if (std::min(a, b) > kShortBone) bones[j].push_back({bone, image, tolerance});
      return absl::OkStatus();
    };
    for (const int child : skeleton.children(j)) {
      const Joint& joint = skeleton.joint(child);
      POISE_RETURN_IF_ERROR(add(joint.offset, skeleton.joint(partners[child]).offset,
                                girdle[child] ? kSameGirdle : kSameLimb, joint.name));
    }
    const auto &tip = skeleton.joint(j).end_site, &tip_image = skeleton.joint(partners[j]).end_site;
    if (tip && tip_image) {
      POISE_RETURN_IF_ERROR(
          add(*tip, *tip_image, kSameLimb, "the tip of " + skeleton.joint(j).name));
    }
  }
  return bones;
}

// Whether `frame` takes every bone to its image, within the bone's own tolerance or this one.
bool Mirrors(const Mat3& frame, std::span<const BonePair> bones, double at_least = 0) {
  return std::all_of(bones.begin(), bones.end(), [&](const BonePair& pair) {
    return Angle(frame * pair.bone, pair.image) <= std::max(pair.tolerance, at_least);
  });
}

// The reflection among the coordinate planes (and, off the trunk, the point reflection) that is
// nearest to `frame`.
Mat3 NearestSignMatrix(const Mat3& frame, bool trunk) {
  Mat3 nearest = -Mat3::Identity();
  double best = trunk ? -1e9 : -frame.trace();
  for (int axis = 0; axis < 3; ++axis) {
    const Mat3 candidate = Reflection(Vec3::Unit(axis));
    const double score = candidate.cwiseProduct(frame).sum();
    if (score > best) {
      best = score;
      nearest = candidate;
    }
  }
  return nearest;
}

// A reflection in a plane: swaps the bones of both sides as well as one can, else stays near
// `expected`.
Mat3 FitTrunkFrame(const Mat3& expected, std::span<const BonePair> bones) {
  // |M a - b|^2 with M = 1 - 2 n n^T is smallest for the n with the smallest n^T (a b^T) n.
  Mat3 spread = 1e-3 * (expected + expected.transpose());
  for (const BonePair& pair : bones) {
    const Mat3 outer = pair.bone.normalized() * pair.image.normalized().transpose();
    spread += outer + outer.transpose();
  }
  return Reflection(Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(0));
}

// The improper orthogonal matrix nearest to `m`.
Mat3 NearestImproper(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant();
  return svd.matrixU() * Vec3(1, 1, -sign).asDiagonal() * svd.matrixV().transpose();
}

// Takes bones onto their images; what they leave open follows `expected`.
Mat3 FitLimbFrame(const Mat3& expected, std::span<const BonePair> bones) {
  const Mat3 start = NearestImproper(expected);
  if (bones.empty()) return start;
  if (bones.size() == 1) {
    return math::SwingBetween(start * bones[0].bone, bones[0].image).toRotationMatrix() * start;
  }
  Mat3 sum = 1e-3 * start;
  for (const BonePair& pair : bones) {
    sum += pair.image.normalized() * pair.bone.normalized().transpose();
  }
  return NearestImproper(sum);
}

// The plane that mirrors the rest pose, if the rest pose is symmetric at all: one reflection for
// every joint, each bone within its own tolerance or `at_least`.
std::optional<Mat3> RestReflection(const Skeleton& skeleton, std::span<const int> partners,
                                   const BonePairs& bones, double at_least) {
  std::vector<Vec3> rest(skeleton.num_joints(), Vec3::Zero());
  Vec3 across = Vec3::Zero();
  for (int j = 1; j < skeleton.num_joints(); ++j) {
    rest[j] = rest[skeleton.parent(j)] + skeleton.joint(j).offset;
  }
  for (int j = 1; j < skeleton.num_joints(); ++j) {
    const Vec3 between = rest[j] - rest[partners[j]];
    across += across.dot(between) < 0 ? Vec3(-between) : between;
  }
  if (across.norm() < kShortBone) return std::nullopt;
  const Mat3 free = Reflection(across);
  for (const Mat3& candidate : {NearestSignMatrix(free, true), free}) {
    const bool fits = std::all_of(bones.begin(), bones.end(), [&](const auto& of_joint) {
      return Mirrors(candidate, of_joint, at_least);
    });
    if (fits) return candidate;
  }
  return std::nullopt;
}

// Mean local rotation of each joint (as the sum of matrices, not normalised) and mean direction
// from right to left hip in the root's frame.
struct AveragePose {
  std::vector<Mat3> local;
  Vec3 root_from_hips = Vec3::Zero();
};

AveragePose Average(const Clip& clip, const JointRoles& roles) {
  AveragePose average{std::vector<Mat3>(clip.num_joints(), Mat3::Zero()), Vec3::Zero()};
  const int step = std::max(1, clip.num_frames() / kSampledFrames);
  WorldPoses world;
  for (int frame = 0; frame < clip.num_frames(); frame += step) {
    ForwardKinematics(clip, frame, 1, world);
    average.root_from_hips +=
        world.rotation(0, 0).conjugate() * (world.position(0, roles.joint(JointRole::kLeftHip)) -
                                            world.position(0, roles.joint(JointRole::kRightHip)));
    for (int j = 0; j < clip.num_joints(); ++j) {
      average.local[j] += clip.rotation(frame, j).toRotationMatrix();
    }
  }
  return average;
}

}  // namespace

StatusOr<std::vector<Mat3>> FindMirrorFrames(const Clip& clip, const JointRoles& roles,
                                             std::span<const int> partners) {
  const Skeleton& skeleton = *clip.skeleton();
  POISE_ASSIGN_OR_RETURN(const BonePairs bones, CollectBones(skeleton, roles, partners));
  if (const auto one = RestReflection(skeleton, partners, bones, 0)) {
    return std::vector<Mat3>(skeleton.num_joints(), *one);
  }
  const auto stance = RestReflection(skeleton, partners, bones, kCaughtRestPose);
  const AveragePose average = stance ? AveragePose{} : Average(clip, roles);
  std::vector<Mat3> frames(skeleton.num_joints());
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    if (partners[j] < j) {
      frames[j] = frames[partners[j]].transpose();
      continue;
    }
    // Without a symmetric rest pose we expect that the average pose is about symmetric:
    // R = M_parent^T R_partner M on average.
    const Mat3 expected = stance   ? *stance
                          : j == 0 ? Reflection(average.root_from_hips)
                                   : Mat3(average.local[partners[j]].transpose() *
                                          frames[skeleton.parent(j)] * average.local[j]);
    const bool trunk = partners[j] == j;
    // Local axes are coordinate axes as a rule: no clip's average should bend them.
    const Mat3 plain = stance ? *stance : NearestSignMatrix(expected, trunk);
    if (Mirrors(plain, bones[j])) {
      frames[j] = plain;
    } else {
      frames[j] = trunk ? FitTrunkFrame(expected, bones[j]) : FitLimbFrame(expected, bones[j]);
    }
  }
  return frames;
}

}  // namespace poise::motion
