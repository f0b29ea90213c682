#include "core/prediction/training/training_config.h"

#include <fmt/format.h>

namespace poise::prediction {
namespace {

PredictorTraining Gcn() {
  PredictorTraining config;
  config.family = "gcn";
  config.members = 1;
  config.trainer = {.steps = 53'000, .batch_size = 16, .validate_every = 1000};
  config.optimizer = {.type = "adam",
                      .learning_rate = 5e-4,
                      .schedule = "step",
                      .decay_every = 2125,
                      .decay_factor = 0.96,
                      .clip_norm = 1};
  config.least_future_frames = config.gcn.future_frames;
  config.balanced = config.mirror = config.speeds = false;
  return config;
}

}  // namespace

StatusOr<PredictorTraining> PredictorTraining::FromPreset(std::string_view name) {
  if (name == "recommended") return PredictorTraining();
  if (name == "gcn") return Gcn();
  return base::InvalidArgument(
      "UNKNOWN_PRESET", "preset",
      fmt::format("unknown preset '{}', expected recommended or gcn", name));
}

std::vector<base::Field> PredictorTraining::Fields() {
  std::vector<base::Field> fields = {base::Text("family", &family, {"mixer", "gcn"}),
                                     base::Number("members", &members, 1, 64)};
  base::Append(fields, base::Nested("mixer", mixer.Fields()));
  base::Append(fields, base::Nested("gcn", gcn.Fields()));
  base::Append(fields, base::Nested("trainer", trainer.Fields()));
  base::Append(fields, base::Nested("optimizer", optimizer.Fields()));
  base::Append(fields, {base::Number("validation_share", &validation_share, 0, 0.5),
                        base::Number("least_future_frames", &least_future_frames, 1, 1000),
                        base::Flag("balanced", &balanced), base::Flag("mirror", &mirror),
                        base::Flag("speeds", &speeds)});
  return fields;
}

Status PredictorTraining::Validate() {
  POISE_RETURN_IF_ERROR(base::CheckRanges(Fields()));
  POISE_RETURN_IF_ERROR(mixer.Validate());
  POISE_RETURN_IF_ERROR(gcn.Validate());
  POISE_RETURN_IF_ERROR(trainer.Validate());
  return optimizer.Validate();
}

}  // namespace poise::prediction
