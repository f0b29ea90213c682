#include "core/motion/distribution/motion_features.h"

#include <numbers>

#include "core/motion/editing/align.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/editing/resample.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/metrics/plausibility.h"
#include "core/motion/pose_codec.h"

namespace poise::motion {
namespace {

constexpr int kPoses = 32;
constexpr int kRootColumns = 9;
constexpr RotationCodec kMatrix{.representation = RotationRepresentation::kMatrix};
constexpr RotationCodec kSixD{.representation = RotationRepresentation::kSixD};

double MeanSpeed(const Clip& clip) {
  const WorldPoses world = ForwardKinematics(clip);
  double sum = 0;
  for (int frame = 1; frame < world.num_frames; ++frame) {
    for (int joint = 0; joint < world.num_joints; ++joint) {
      sum += (world.position(frame, joint) - world.position(frame - 1, joint)).norm();
    }
  }
  return sum * clip.frame_rate() / ((world.num_frames - 1) * world.num_joints);
}

Eigen::VectorXd Descriptor(const PoseMatrix& poses, double duration) {
  Eigen::VectorXd descriptor(poses.size() + 1);
  descriptor << Eigen::Map<const Eigen::VectorXd>(poses.data(), poses.size()), duration;
  return descriptor;
}

}  // namespace

StatusOr<MotionFeatures> DescribeMotion(const Clip& clip, const JointRoles& roles) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  POISE_ASSIGN_OR_RETURN(const Plausibility plausibility, AssessPlausibility(clip, roles));
  POISE_ASSIGN_OR_RETURN(const Clip aligned, Align(clip, roles));
  POISE_ASSIGN_OR_RETURN(const Clip reduced,
                         ReduceToRoles(aligned, roles, ReductionMode::kComposed));
  POISE_ASSIGN_OR_RETURN(const Clip frames, Resample(reduced, kComparisonRate));
  POISE_ASSIGN_OR_RETURN(const Clip poses, ResampleToFrames(reduced, kPoses));
  if (frames.num_frames() < 2) {
    return base::FailedPrecondition("CLIP_TOO_SHORT", "clip",
                                    "a motion needs two frames at 30 Hz to be compared");
  }
  MotionFeatures features;
  const PoseMatrix matrices = EncodePoses(frames, kMatrix, /*with_root_position=*/false);
  // |R_a - R_b|^2 = 8 sin^2(angle / 2)
  features.rotations =
      (matrices.rightCols(matrices.cols() - kRootColumns) / std::numbers::sqrt2).cast<float>();
  features.descriptor = Descriptor(EncodePoses(poses, kSixD), clip.duration());
  features.duration_s = clip.duration();
  features.mean_speed_mps = MeanSpeed(frames);
  features.foot_skate_mps = plausibility.foot_skate_mps;
  return features;
}

}  // namespace poise::motion
