#ifndef POISE_CORE_PREDICTION_BODY_MAPPING_H_
#define POISE_CORE_PREDICTION_BODY_MAPPING_H_

#include <optional>
#include <vector>

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::prediction {

/// One motion on the body of a model, and the way back for what follows it.
///
/// There: motion::Retarget by roles; where the skeletons agree (names, parents, directions of
/// bones) rotations are copied. Back: a joint turns in the world as the joint that drives it, from
/// where the source's last frame left it, so that nothing jumps and constant differences between
/// the two bodies (frames, proportions, rest poses) do not matter. Joints that the model lacks keep
/// their last local rotation. The root moves as the model's, scaled by leg length.
class BodyMapping {
 public:
  /// Errors: kFailedPrecondition MISSING_ROLES, DEGENERATE_SKELETON.
  static StatusOr<BodyMapping> Create(motion::Clip source, const motion::JointRoles& roles,
                                      const motion::SkeletonPtr& model);

  /// The motion on the model's body.
  const motion::Clip& on_model() const { return on_model_; }

  /// A continuation of on_model() at any rate, on the source's body.
  /// Precondition: the skeleton of on_model().
  StatusOr<motion::Clip> Back(const motion::Clip& future) const;

 private:
  BodyMapping(motion::Clip source, motion::Clip on_model, std::vector<int> driving, double scale)
      : source_(std::move(source)),
        on_model_(std::move(on_model)),
        driving_(std::move(driving)),
        scale_(scale) {}

  motion::Clip source_;
  motion::Clip on_model_;
  std::vector<int> driving_;  // (source joints) joint of the model, or -1; empty: the bodies agree
  double scale_;              // source length / model length
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_BODY_MAPPING_H_
