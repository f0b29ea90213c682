#ifndef POISE_CORE_PIPELINE_AUGMENT_H_
#define POISE_CORE_PIPELINE_AUGMENT_H_

#include <memory>
#include <vector>

#include "core/api/augment_spec.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"
#include "core/synthesis/motion_decoder.h"

namespace poise::pipeline {

/// The network that step "vae" uses.
using MotionDecoderPtr = std::shared_ptr<const synthesis::MotionDecoder>;

/// A source whose bytes have become a clip.
struct ResolvedSource {
  motion::Clip clip;
  motion::JointRoles roles;
};

/// The augmentation flow: variants of clips, one at a time and in any order, so that the caller
/// sets the pace and may use several threads. Variant `ordinal` is variant ordinal %
/// variants_per_source of source ordinal / variants_per_source; it draws from its own random stream
/// (DeriveSeed(seed, {source, index})), so threads and order do not change it.
class AugmentFlow {
 public:
  /// Errors: those of AugmentSpec::Validate; kInvalidArgument UNKNOWN_METHOD, MISSING_MODEL,
  /// UNKNOWN_ACTION_CLASS,
  /// UNKNOWN_CONFIG_KEY and the other config errors; what the methods need of the clips
  /// (MISSING_ROLES, CLIP_TOO_SHORT), with the field "sources[i]".
  static StatusOr<std::unique_ptr<AugmentFlow>> Create(const api::AugmentSpec& spec,
                                                       std::vector<ResolvedSource> sources,
                                                       MotionDecoderPtr decoder = nullptr);
  ~AugmentFlow();

  int64_t num_variants() const;
  /// Threads: may be called from several threads. Errors: kCancelled, kDeadlineExceeded; kInternal
  /// when a number became NaN.
  StatusOr<api::Variant> Make(int64_t ordinal, const base::RunContext& context) const;

 private:
  class Implementation;
  explicit AugmentFlow(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_AUGMENT_H_
