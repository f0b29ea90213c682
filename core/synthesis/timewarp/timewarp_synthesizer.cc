#include "core/synthesis/timewarp/timewarp_synthesizer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/motion/editing/resample.h"

namespace poise::synthesis {
namespace {

class BoundTimewarp : public BoundSynthesizer {
 public:
  BoundTimewarp(const Draft& source, const TimewarpConfig& config)
      : source_(source), config_(config) {}

  StatusOr<Draft> Sample(base::Random& random, const base::RunContext& context) const override {
    POISE_RETURN_IF_ERROR(context.Check());
    const double factor = random.Uniform(config_.factor_low, config_.factor_high);
    const int steps = static_cast<int>(std::lround((source_.clip.num_frames() - 1) * factor));
    POISE_ASSIGN_OR_RETURN(motion::Clip clip,
                           motion::ResampleToFrames(source_.clip, std::max(steps, 1) + 1));
    return Draft{.clip = std::move(clip), .ik = source_.ik};
  }

 private:
  const Draft& source_;
  TimewarpConfig config_;
};

}  // namespace

std::vector<base::Field> TimewarpConfig::Fields() {
  return {base::Number("factor_low", &factor_low, 0.1, 10),
          base::Number("factor_high", &factor_high, 0.1, 10)};
}

Status TimewarpConfig::Validate() const {
  if (factor_low <= factor_high) return absl::OkStatus();
  return base::InvalidArgument(
      "CONFIG_VALUE_OUT_OF_RANGE", "timewarp.factor_low",
      fmt::format("'timewarp.factor_low' is {}, above 'timewarp.factor_high' = {}", factor_low,
                  factor_high));
}

Status TimewarpSynthesizer::Check(const motion::Clip& clip, const motion::JointRoles&) const {
  if (clip.num_frames() >= kMinFrames) return absl::OkStatus();
  return base::FailedPrecondition(
      "CLIP_TOO_SHORT", "",
      fmt::format("clip '{}' has {} frame, a time warp needs at least {}", clip.name(),
                  clip.num_frames(), kMinFrames));
}

StatusOr<std::unique_ptr<BoundSynthesizer>> TimewarpSynthesizer::Bind(
    const Draft& source, const motion::JointRoles& roles) const {
  POISE_RETURN_IF_ERROR(Check(source.clip, roles));
  return std::make_unique<BoundTimewarp>(source, config_);
}

}  // namespace poise::synthesis
