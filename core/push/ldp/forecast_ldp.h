#ifndef POISE_CORE_PUSH_LDP_FORECAST_LDP_H_
#define POISE_CORE_PUSH_LDP_FORECAST_LDP_H_

#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/push/takes/push_protocol.h"
#include "core/push/takes/push_take.h"

namespace poise::push::ldp {

/// Forecasts takes by a model of TrainLdp, with the networks as they are trained (in LibTorch). The
/// answer has for each take, per person, (frames, kBodyJoints) [m] in the ground frame. Joints are
/// what the decoders say: bones may stretch. Samplers give the mean of their latents; without
/// pendulums latents are drawn with the seed of `context`, which also draws protocol C's noise.
/// Errors: kFailedPrecondition WRONG_FAMILY; those of LoadState and of the card's config;
/// kCancelled, kDeadlineExceeded.
StatusOr<std::vector<std::vector<std::vector<Vec3>>>> ForecastTakes(
    const artifacts::ModelArtifact& model, std::span<const PushTake* const> takes,
    Protocol protocol, const base::RunContext& context);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_FORECAST_LDP_H_
