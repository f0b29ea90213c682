#include "core/synthesis/mirror/mirror_synthesizer.h"

#include "core/motion/editing/mirror.h"

namespace poise::synthesis {
namespace {

class BoundMirror : public BoundSynthesizer {
 public:
  explicit BoundMirror(Draft mirrored) : mirrored_(std::move(mirrored)) {}

  StatusOr<Draft> Sample(base::Random&, const base::RunContext& context) const override {
    POISE_RETURN_IF_ERROR(context.Check());
    return mirrored_;
  }

 private:
  Draft mirrored_;
};

}  // namespace

Status MirrorSynthesizer::Check(const motion::Clip&, const motion::JointRoles& roles) const {
  return roles.RequireComplete();
}

StatusOr<std::unique_ptr<BoundSynthesizer>> MirrorSynthesizer::Bind(
    const Draft& source, const motion::JointRoles& roles) const {
  POISE_ASSIGN_OR_RETURN(motion::Clip clip, motion::Mirror(source.clip, roles));
  Draft mirrored{.clip = std::move(clip), .ik = source.ik};
  if (mirrored.ik) {
    mirrored.ik->end_effector = motion::MirrorRole(mirrored.ik->end_effector);
    mirrored.ik->target.x() = -mirrored.ik->target.x();
  }
  return std::make_unique<BoundMirror>(std::move(mirrored));
}

}  // namespace poise::synthesis
