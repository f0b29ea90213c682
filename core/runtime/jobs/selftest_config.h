#ifndef POISE_CORE_RUNTIME_JOBS_SELFTEST_CONFIG_H_
#define POISE_CORE_RUNTIME_JOBS_SELFTEST_CONFIG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::jobs {

/// What a job of kind `selftest` does: it stands in for long work, and fails in every way in which
/// work can fail.
struct SelftestConfig {
  int64_t steps = 10;             ///< [0, 10^9]
  int64_t step_ms = 10;           ///< [ms, 0 to 10^6] that a step takes
  bool busy = false;              ///< a step computes instead of sleeping
  int64_t checkpoint_every = 0;   ///< [steps] 0: by time, as the worker says
  int artifacts = 1;              ///< [0, 5,000] files of the result
  int64_t artifact_bytes = 1024;  ///< [0, 2^30] of each

  int64_t fail_at = 0;  ///< [step] after which it fails; 0 = never
  /// unavailable (a retry may cure it), invalid, diverge: errors | crash, segfault, exit: the
  /// process ends | hang: no step any more | throw: a C++ exception | out_of_memory
  std::string failure = "unavailable";
  int64_t fail_attempts = 1000;  ///< attempts after this number do not fail

  /// Asked to stop: obey (checkpoint, then return) | ignore (carry on).
  std::string on_stop = "obey";

  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument, as FieldsFromJson, with a field below "spec.parameters".
  static StatusOr<SelftestConfig> FromParameters(const base::Json& parameters);
};

/// Whether FromParameters takes them; the check of the flow table.
Status ValidateSelftest(const base::Json& parameters);

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_SELFTEST_CONFIG_H_
