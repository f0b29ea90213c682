#include "core/synthesis/vae/vae_synthesizer.h"

#include <utility>

#include "core/motion/editing/reduce.h"
#include "core/motion/editing/resample.h"
#include "core/motion/editing/retarget.h"

namespace poise::synthesis {
namespace {

class Bound : public BoundSynthesizer {
 public:
  Bound(const Draft& source, const motion::JointRoles& roles, const MotionDecoder& decoder,
        const LatentSampler& sampler, motion::JointRoles decoder_roles)
      : source_(source),
        roles_(roles),
        decoder_(decoder),
        sampler_(sampler),
        decoder_roles_(std::move(decoder_roles)) {}

  StatusOr<Draft> Sample(base::Random& random, const base::RunContext& context) const override {
    POISE_RETURN_IF_ERROR(context.Check());
    const motion::Clip& source = source_.clip;
    POISE_ASSIGN_OR_RETURN(const motion::Clip made,
                           decoder_.Decode(sampler_.Draw(random), source.name()));
    POISE_ASSIGN_OR_RETURN(const motion::Clip on_body,
                           motion::Retarget(made, decoder_roles_, source.skeleton(), roles_,
                                            {.target_reference = &source}));
    POISE_ASSIGN_OR_RETURN(motion::Clip clip, motion::Resample(on_body, source.frame_rate()));
    return Draft{.clip = std::move(clip), .ik = {}};
  }

 private:
  const Draft& source_;
  const motion::JointRoles& roles_;
  const MotionDecoder& decoder_;
  const LatentSampler& sampler_;
  const motion::JointRoles decoder_roles_;
};

}  // namespace

Status VaeSynthesizer::Check(const motion::Clip&, const motion::JointRoles& roles) const {
  return roles.RequireComplete();
}

StatusOr<std::unique_ptr<BoundSynthesizer>> VaeSynthesizer::Bind(
    const Draft& source, const motion::JointRoles& roles) const {
  POISE_RETURN_IF_ERROR(Check(source.clip, roles));
  POISE_ASSIGN_OR_RETURN(motion::JointRoles decoder_roles,
                         motion::ReducedRoles(*decoder_->skeleton()));
  return std::make_unique<Bound>(source, roles, *decoder_, sampler_, std::move(decoder_roles));
}

}  // namespace poise::synthesis
