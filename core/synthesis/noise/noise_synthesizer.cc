#include "core/synthesis/noise/noise_synthesizer.h"

#include <cmath>

namespace poise::synthesis {
namespace {

using motion::Quat;
using motion::Vec3;

constexpr int kFramesBetweenChecks = 64;

// Standard deviation of the root's position, per axis.
Vec3 PositionDeviation(const motion::Clip& clip) {
  Vec3 mean = Vec3::Zero(), square = Vec3::Zero();
  for (const Vec3& position : clip.root_positions()) mean += position;
  mean /= clip.num_frames();
  for (const Vec3& position : clip.root_positions()) square += (position - mean).cwiseAbs2();
  return (square / clip.num_frames()).cwiseSqrt();
}

// The same of a joint's rotation vector from the mean rotation.
Vec3 RotationDeviation(const motion::Clip& clip, int joint) {
  const Quat& first = clip.rotation(0, joint);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    const Eigen::Vector4d rotation = clip.rotation(frame, joint).coeffs();
    // q and -q are the same rotation.
    sum += rotation.dot(first.coeffs()) < 0 ? Eigen::Vector4d(-rotation) : rotation;
  }
  const Quat mean = sum.norm() > 1e-9 ? Quat(sum.normalized()) : first;
  Vec3 center = Vec3::Zero(), square = Vec3::Zero();
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    const Vec3 vector = math::ToRotationVector(mean.conjugate() * clip.rotation(frame, joint));
    center += vector;
    square += vector.cwiseAbs2();
  }
  center /= clip.num_frames();
  const Vec3 variance = square / clip.num_frames() - center.cwiseAbs2();
  // Below the rounding of unit quaternions the joint does not move.
  return variance.cwiseMax(0).cwiseSqrt().unaryExpr([](double s) { return s < 1e-7 ? 0 : s; });
}

class BoundNoise : public BoundSynthesizer {
 public:
  BoundNoise(const Draft& source, const NoiseConfig& config)
      : source_(source), root_(config.fraction * PositionDeviation(source.clip)) {
    for (int joint = 0; joint < source.clip.num_joints(); ++joint) {
      joints_.push_back(config.fraction * RotationDeviation(source.clip, joint));
    }
  }

  StatusOr<Draft> Sample(base::Random& random, const base::RunContext& context) const override {
    Draft draft = source_;
    const auto draw = [&](const Vec3& deviation) {
      const double x = random.Normal(), y = random.Normal(), z = random.Normal();
      return Vec3(deviation.x() * x, deviation.y() * y, deviation.z() * z);
    };
    for (int frame = 0; frame < draft.clip.num_frames(); ++frame) {
      if (frame % kFramesBetweenChecks == 0) POISE_RETURN_IF_ERROR(context.Check());
      if (!root_.isZero(0)) draft.clip.root_position(frame) += draw(root_);
      for (int joint = 0; joint < draft.clip.num_joints(); ++joint) {
        if (joints_[joint].isZero(0)) continue;
        Quat& rotation = draft.clip.rotation(frame, joint);
        rotation = (rotation * math::FromRotationVector(draw(joints_[joint]))).normalized();
      }
    }
    return draft;
  }

 private:
  const Draft& source_;
  Vec3 root_;                 // [m] standard deviation of the noise
  std::vector<Vec3> joints_;  // (joints) [rad]
};

}  // namespace

std::vector<base::Field> NoiseConfig::Fields() {
  return {base::Number("fraction", &fraction, 0, 10)};
}

Status NoiseSynthesizer::Check(const motion::Clip&, const motion::JointRoles&) const {
  return absl::OkStatus();
}

StatusOr<std::unique_ptr<BoundSynthesizer>> NoiseSynthesizer::Bind(
    const Draft& source, const motion::JointRoles&) const {
  return std::make_unique<BoundNoise>(source, config_);
}

}  // namespace poise::synthesis
