#include "core/runtime/jobs/selftest_config.h"

namespace poise::jobs {

std::vector<base::Field> SelftestConfig::Fields() {
  return {
      base::Number("steps", &steps, 0, 1'000'000'000),
      base::Number("step_ms", &step_ms, 0, 1'000'000),
      base::Flag("busy", &busy),
      base::Number("checkpoint_every", &checkpoint_every, 0, 1'000'000'000),
      base::Number("artifacts", &artifacts, 0, 5000),
      base::Number("artifact_bytes", &artifact_bytes, 0, int64_t{1} << 30),
      base::Number("fail_at", &fail_at, 0, 1'000'000'000),
      base::Text("failure", &failure,
                 {"unavailable", "invalid", "diverge", "crash", "segfault", "exit", "hang", "throw",
                  "out_of_memory"}),
      base::Number("fail_attempts", &fail_attempts, 0, 1'000'000'000),
      base::Text("on_stop", &on_stop, {"obey", "ignore"}),
  };
}

StatusOr<SelftestConfig> SelftestConfig::FromParameters(const base::Json& parameters) {
  SelftestConfig config;
  const Status status = base::FieldsFromJson(parameters, config.Fields());
  if (!status.ok()) return base::Annotate(status, "selftest", "spec.parameters");
  return config;
}

Status ValidateSelftest(const base::Json& parameters) {
  return SelftestConfig::FromParameters(parameters).status();
}

}  // namespace poise::jobs
