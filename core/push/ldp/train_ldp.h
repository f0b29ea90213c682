#ifndef POISE_CORE_PUSH_LDP_TRAIN_LDP_H_
#define POISE_CORE_PUSH_LDP_TRAIN_LDP_H_

#include <optional>
#include <string>
#include <vector>

#include "core/push/ldp/ldp_config.h"
#include "core/push/training/train_push.h"

namespace poise::push::ldp {

/// What is learned, from what.
struct LdpTask {
  const std::vector<PushTake>& takes;  ///< of which the test takes are not looked at
  LdpTraining config;
  // For the card:
  std::string data = {};
  std::string data_fingerprint = {};
  std::string data_license = {};
};

/// Trains the parts in the paper's order: balance on single people, interaction on several with
/// balance frozen, then for legs and trunk the CVAE and its sampler, at last everything together.
/// Each chooses its step on the validation takes. With the same seed the weights are the same bit
/// for bit, however often the training was interrupted.
/// The card's scores: of each part its validation ("balance", ...), and validation_single_mpjpe_m,
/// validation_several_mpjpe_m of the whole.
/// Errors: config errors; kInvalidArgument NO_TAKES; kDataLoss CORRUPT_CHECKPOINT; those of
/// Trainer.
StatusOr<PushResult> TrainLdp(const LdpTask& task, const base::RunContext& context,
                              const std::optional<std::string>& checkpoint = {},
                              const learning::CheckpointSink& sink = {});

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_TRAIN_LDP_H_
