#include <cstdint>
#include <string_view>

#include "core/api/correct_spec.h"
#include "core/api/correction_report.h"
#include "core/api/data_set.h"
#include "core/api/model_card.h"
#include "core/base/json.h"
#include "core/motion/joint_roles.h"
#include "core/motion/skeleton_json.h"

// Everything that is written as JSON: a mapping of roles, a skeleton, the parameters of a
// correction, the records of models and data sets, the report in a manifest.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto json = poise::base::ParseJson(text, "fuzz");
  poise::motion::JointRoles::ParseOverrides(text).status().IgnoreError();
  if (!json.ok()) return 0;
  poise::motion::SkeletonFromJson(*json).status().IgnoreError();
  poise::api::CorrectSpec::FromJson(*json).status().IgnoreError();
  poise::api::ModelCardFromJson(*json).status().IgnoreError();
  poise::api::DataSetFromJson(*json).status().IgnoreError();
  poise::api::CorrectedClipFromJson(*json).status().IgnoreError();
  poise::api::CorrectedVariantFromJson(*json).status().IgnoreError();
  poise::api::ZeroPolicyFromJson(*json).status().IgnoreError();
  return 0;
}
