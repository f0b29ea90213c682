#ifndef POISE_CORE_SYNTHESIS_IK_IK_SYNTHESIZER_H_
#define POISE_CORE_SYNTHESIS_IK_IK_SYNTHESIZER_H_

#include <memory>

#include "core/synthesis/ik/action_classes.h"
#include "core/synthesis/ik/ik_config.h"
#include "core/synthesis/synthesizer.h"

namespace poise::synthesis {

/// Variants that differ in where one limb goes: at the clip's keyframe its end effector meets a
/// random target in a fan around where it was, and the displacement fades out over time. All other
/// joints, the root and the timing stay bit for bit.
/// Source: MotionAug sec. 3.2, 4.3; reference sec. 3.
/// Errors of Check: kFailedPrecondition MISSING_ROLES, BAD_LIMB, CLIP_TOO_SHORT; kInvalidArgument
/// KEYFRAME_OUT_OF_RANGE.
class IkSynthesizer : public Synthesizer {
 public:
  static constexpr int kMinFrames = 4;

  IkSynthesizer(const ActionClass& action_class, const IkConfig& config)
      : action_class_(action_class), config_(config) {}

  Status Check(const motion::Clip& clip, const motion::JointRoles& roles) const override;
  StatusOr<std::unique_ptr<BoundSynthesizer>> Bind(const Draft& source,
                                                   const motion::JointRoles& roles) const override;

 private:
  ActionClass action_class_;
  IkConfig config_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_IK_SYNTHESIZER_H_
