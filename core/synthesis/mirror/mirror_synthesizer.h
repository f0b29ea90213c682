#ifndef POISE_CORE_SYNTHESIS_MIRROR_MIRROR_SYNTHESIZER_H_
#define POISE_CORE_SYNTHESIS_MIRROR_MIRROR_SYNTHESIZER_H_

#include <memory>

#include "core/synthesis/synthesizer.h"

namespace poise::synthesis {

/// The clip mirrored about the world's Y-Z plane, left and right exchanged
/// (motion/editing/mirror.h) and the outcome of earlier IK with it. Draws nothing. Source:
/// MotionAug, reference sec. 1.4.
class MirrorSynthesizer : public Synthesizer {
 public:
  Status Check(const motion::Clip& clip, const motion::JointRoles& roles) const override;
  StatusOr<std::unique_ptr<BoundSynthesizer>> Bind(const Draft& source,
                                                   const motion::JointRoles& roles) const override;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_MIRROR_MIRROR_SYNTHESIZER_H_
