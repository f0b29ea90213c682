#include "core/prediction/training/training_config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace poise::prediction {
namespace {

constexpr int kMotionAugFrames = 12;  // in and out, at 30 Hz

// Every window equally often, as recorded, and no other: as the published networks were trained.
PredictorTraining AsPublished(const char* family) {
  PredictorTraining config;
  config.family = family;
  config.members = 1;
  config.balanced = config.mirror = config.speeds = false;
  config.validation_share = 0.1;
  config.least_future_frames = 1000;  // no window reaches over the end of its sequence
  return config;
}

// LTD: 50 epochs of 17,000 windows, the rate times 0.96 every second epoch.
PredictorTraining Gcn() {
  PredictorTraining config = AsPublished("gcn");
  config.trainer = {.steps = 53'000, .batch_size = 16, .validate_every = 1000};
  config.optimizer = {.type = "adam",
                      .learning_rate = 5e-4,
                      .schedule = "step",
                      .decay_every = 2125,
                      .decay_factor = 0.96,
                      .clip_norm = 1};
  return config;
}

// The original's step size and clipping (reference sec. 4.1).
PredictorTraining Rnn() {
  PredictorTraining config = AsPublished("rnn");
  config.trainer = {.steps = 100'000, .batch_size = 16, .validate_every = 1000};
  config.optimizer = {.type = "sgd",
                      .learning_rate = 5e-3,
                      .schedule = "step",
                      .decay_every = 10'000,
                      .decay_factor = 0.95,
                      .clip_norm = 5};
  return config;
}

// 500 epochs of 200 steps, after a warm-up of 100 the rate times 0.1 every 400.
PredictorTraining Potr() {
  PredictorTraining config = AsPublished("potr");
  config.trainer = {.steps = 100'000, .batch_size = 16, .validate_every = 1000};
  config.optimizer = {.type = "adamw",
                      .learning_rate = 1e-4,
                      .weight_decay = 1e-5,
                      .warmup_steps = 20'000,
                      .schedule = "step",
                      .decay_every = 80'000,
                      .decay_factor = 0.1,
                      .clip_norm = 0.1};
  return config;
}

PredictorTraining Simlpe() {
  PredictorTraining config = AsPublished("simlpe");
  config.trainer = {.steps = 40'000, .batch_size = 256, .validate_every = 1000};
  config.optimizer = {.type = "adam",
                      .learning_rate = 3e-4,
                      .weight_decay = 1e-4,
                      .schedule = "step",
                      .decay_every = 30'000,
                      .decay_factor = 1.0 / 30};
  return config;
}

// MotionAug's 50 epochs, of a class of some 1,200 windows: Adam, the rate times 0.96 every second.
PredictorTraining MotionAug(const char* family) {
  PredictorTraining config = AsPublished(family);
  config.trainer = {.steps = 950, .batch_size = 64, .validate_every = 100};
  config.optimizer = {.type = "adam",
                      .learning_rate = 5e-4,
                      .schedule = "step",
                      .decay_every = 38,
                      .decay_factor = 0.96,
                      .clip_norm = 1};
  config.validation_share = 0;
  config.rnn = {.past_frames = kMotionAugFrames,
                .future_frames = kMotionAugFrames,
                .hidden = 64,
                .root = true,
                .normalised = false,
                .squared = false};
  config.gcn = {.past_frames = kMotionAugFrames,
                .future_frames = kMotionAugFrames,
                .coefficients = 20,
                .root = true,
                .moving = false};
  config.potr = {.past_frames = kMotionAugFrames, .future_frames = kMotionAugFrames, .root = true};
  return config;
}

// Few and short clips.
PredictorTraining RecommendedHdm05() {
  PredictorTraining config;
  config.members = 1;
  config.mixer.past_frames = config.mixer.future_frames = kMotionAugFrames;
  config.trainer.steps = 1000;
  return config;
}

struct Preset {
  const char* name;
  PredictorTraining (*make)();
};

constexpr Preset kPresets[] = {
    {"recommended", [] { return PredictorTraining(); }},
    {"gcn", Gcn},
    {"rnn", Rnn},
    {"potr", Potr},
    {"simlpe", Simlpe},
    {"recommended-hdm05", RecommendedHdm05},
    {"gcn-hdm05", [] { return MotionAug("gcn"); }},
    {"rnn-hdm05", [] { return MotionAug("rnn"); }},
    {"potr-hdm05", [] { return MotionAug("potr"); }},
};

}  // namespace

std::vector<std::string> PredictorTraining::PresetNames() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.push_back(preset.name);
  return names;
}

StatusOr<PredictorTraining> PredictorTraining::FromPreset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (name == preset.name) return preset.make();
  }
  return base::InvalidArgument("UNKNOWN_PRESET", "preset",
                               fmt::format("unknown preset '{}', expected one of: {}", name,
                                           fmt::join(PresetNames(), ", ")));
}

PredictorTraining::Frames PredictorTraining::frames() const {
  if (family == "gcn") return {gcn.past_frames, gcn.future_frames};
  if (family == "rnn") return {rnn.past_frames, rnn.future_frames};
  if (family == "potr") return {potr.past_frames, potr.future_frames};
  if (family == "simlpe") return {simlpe.past_frames, simlpe.future_frames};
  return {mixer.past_frames, mixer.future_frames};
}

std::vector<base::Field> PredictorTraining::Fields() {
  std::vector<base::Field> fields = {
      base::Text("family", &family, {"mixer", "gcn", "rnn", "potr", "simlpe"}),
      base::Number("members", &members, 1, 64)};
  base::Append(fields, base::Nested("mixer", mixer.Fields()));
  base::Append(fields, base::Nested("gcn", gcn.Fields()));
  base::Append(fields, base::Nested("rnn", rnn.Fields()));
  base::Append(fields, base::Nested("potr", potr.Fields()));
  base::Append(fields, base::Nested("simlpe", simlpe.Fields()));
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
  POISE_RETURN_IF_ERROR(potr.Validate());
  POISE_RETURN_IF_ERROR(simlpe.Validate());
  POISE_RETURN_IF_ERROR(trainer.Validate());
  return optimizer.Validate();
}

}  // namespace poise::prediction
