#ifndef POISE_CORE_CORRECTION_DEBIAS_DEBIASER_H_
#define POISE_CORE_CORRECTION_DEBIAS_DEBIASER_H_

#include <memory>
#include <string>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/status.h"
#include "core/correction/debias/debias_config.h"
#include "core/correction/debias/debias_frames.h"
#include "core/motion/joint_roles.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

/// Undoes what a simulated body systematically changes about a motion that it imitates: a network,
/// frame by frame, trained on imitations beside their originals (MotionAug sec. 5). Needs no
/// LibTorch. Constant after construction. Threads: any.
class Debiaser {
 public:
  static constexpr char kFamily[] = "debias";

  /// From the card and weights of a model of this family. Errors: kFailedPrecondition WRONG_FAMILY;
  /// kInvalidArgument MALFORMED_CARD, MISSING_TENSOR, WRONG_SHAPE; config errors.
  static StatusOr<std::shared_ptr<const Debiaser>> Create(const artifacts::ModelArtifact& model);

  /// Whether clips like this one can be debiased; `model` is for the message.
  /// Errors: kFailedPrecondition SIGNATURE_MISMATCH.
  Status CheckFits(const std::string& model, const motion::Clip& clip,
                   const motion::JointRoles& roles) const;

  /// `imitated` has the joints of `body`, which imitated it.
  /// Errors: kInvalidArgument WRONG_SHAPE; kOutOfRange NOT_FINITE.
  StatusOr<motion::Clip> Apply(const motion::Clip& imitated,
                               const physics::HumanoidModel& body) const;

 private:
  /// Rows times weight, plus bias. Shapes: weight (inputs, outputs); bias (outputs)
  struct Layer {
    FrameRows weight;
    Eigen::RowVectorXf bias;
  };

  Debiaser() = default;
  // What the network says, smoothed. Shape: (frames, kCorrectionWidth)
  FrameRows Correction(const motion::Clip& imitated) const;
  void Smooth(FrameRows& rows, double frame_rate) const;
  Status Load(const base::TensorFile& weights);

  DebiasConfig config_;
  motion::MotionSignature signature_;
  Eigen::RowVectorXf mean_, scale_;  // of the inputs
  Eigen::RowVectorXf size_;          // (kCorrectionWidth) of the outputs
  std::vector<Layer> layers_;
};

using DebiaserPtr = std::shared_ptr<const Debiaser>;

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_DEBIASER_H_
