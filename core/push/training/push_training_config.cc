#include "core/push/training/push_training_config.h"

#include <fmt/format.h>

namespace poise::push {

std::vector<base::Field> NetworkTraining::Fields() {
  return {
      base::Number("steps", &steps, int64_t{1}, int64_t{1'000'000}),
      base::Number("batch_size", &batch_size, 1, 1000),
      base::Number("learning_rate", &learning_rate, 1e-8, 1),
      base::Number("weight_decay", &weight_decay, 0, 1),
      base::Number("clip_norm", &clip_norm, 1e-6, 1e6),
      base::Number("validate_every", &validate_every, int64_t{1}, int64_t{1'000'000}),
  };
}

std::vector<base::Field> HipTraining::Fields() {
  std::vector<base::Field> fields = network.Fields();
  base::Append(fields,
               {base::Number("first_frames", &first_frames, 2, 1000),
                base::Number("growing_share", &growing_share, 0, 1),
                base::Number("velocity_weight", &velocity_weight, 0, 10),
                base::Number("lean_weight", &lean_weight, 0, 10),
                base::Number("still_share", &still_share, 0, 1), base::Flag("mirror", &mirror)});
  return fields;
}

std::vector<base::Field> PoseTraining::Fields() {
  std::vector<base::Field> fields = network.Fields();
  base::Append(fields,
               {base::Number("hip_distortion", &hip_distortion, 0, 1),
                base::Number("forecast_share", &forecast_share, 0, 1),
                base::Number("single_share", &single_share, 0, 1),
                base::Number("speed_weight", &speed_weight, 0, 10),
                base::Number("foot_weight", &foot_weight, 0, 10),
                base::Number("swing_weight", &swing_weight, 0, 10), base::Flag("mirror", &mirror)});
  return fields;
}

StatusOr<PushTraining> PushTraining::FromPreset(std::string_view name) {
  if (name == "recommended") return PushTraining();
  return base::InvalidArgument("UNKNOWN_PRESET", "preset",
                               fmt::format("unknown preset '{}', expected recommended", name));
}

std::vector<base::Field> PushTraining::Fields() {
  std::vector<base::Field> fields = {base::Text("protocol", &protocol, {"A", "B", "C"}),
                                     base::Number("hip_members", &hip_members, 1, 64),
                                     base::Number("pose_members", &pose_members, 1, 64),
                                     base::Flag("hold_out", &hold_out),
                                     base::Number("every_take", &every_take, 1, 100)};
  base::Append(fields, base::Nested("hip", hip.Fields()));
  base::Append(fields, base::Nested("pose", pose.Fields()));
  base::Append(fields, base::Nested("hip_training", hip_training.Fields()));
  base::Append(fields, base::Nested("pose_training", pose_training.Fields()));
  base::Append(fields, base::Nested("steps", steps.Fields()));
  return fields;
}

Status PushTraining::Validate() { return base::CheckRanges(Fields()); }

}  // namespace poise::push
