#ifndef POISE_CORE_PIPELINE_PUSH_H_
#define POISE_CORE_PIPELINE_PUSH_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/api/push_forecast.h"
#include "core/api/push_spec.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/pipeline/augment.h"
#include "core/push/push_forecaster.h"

namespace poise::pipeline {

/// The forecast of a scene, frame by frame, so that the caller sets the pace.
/// Threads: one caller at a time.
class PushFlow {
 public:
  /// `bodies` has an entry for each person of the spec; empty where the person has no clip. `model`
  /// names the forecaster in answers. Errors: those of PushSpec::Validate; with the field
  /// "people[i]": FRAME_OUT_OF_RANGE, NOT_STANDING, OVERLAPPING_PEOPLE, kFailedPrecondition
  /// MISSING_ROLES.
  static StatusOr<std::unique_ptr<PushFlow>> Create(
      const api::PushSpec& spec, std::vector<std::optional<ResolvedSource>> bodies,
      const std::string& model, const push::PushForecaster& forecaster);
  ~PushFlow();

  const api::PushForecastScene& scene() const;
  /// The next frame, frame 0 first; call it scene().frames times.
  /// Errors: kCancelled, kDeadlineExceeded; kInternal when a number became NaN.
  StatusOr<api::PushForecastFrame> Next(const base::RunContext& context);

 private:
  class Implementation;
  explicit PushFlow(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_PUSH_H_
