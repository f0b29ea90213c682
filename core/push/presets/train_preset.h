#ifndef POISE_CORE_PUSH_PRESETS_TRAIN_PRESET_H_
#define POISE_CORE_PUSH_PRESETS_TRAIN_PRESET_H_

#include <optional>
#include <string>
#include <vector>

#include "core/base/config_fields.h"
#include "core/push/training/train_push.h"

namespace poise::push {

/// A push model to be trained by the name of its preset: "recommended" (core/push/training) or
/// "paper" (core/push/ldp), each with settings of its own.
struct PresetTask {
  const std::vector<PushTake>& takes;  ///< of which the test takes are not looked at
  std::string preset = "recommended";
  base::Overrides overrides = {};  ///< settings by name
  // For the card:
  std::string data = {};
  std::string data_fingerprint = {};
  std::string data_license = {};
};

/// Errors: those of CheckPreset, TrainPush and ldp::TrainLdp.
StatusOr<PushResult> TrainPreset(const PresetTask& task, const base::RunContext& context,
                                 const std::optional<std::string>& checkpoint = {},
                                 const learning::CheckpointSink& sink = {});

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_PRESETS_TRAIN_PRESET_H_
