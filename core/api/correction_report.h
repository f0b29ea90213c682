#ifndef POISE_CORE_API_CORRECTION_REPORT_H_
#define POISE_CORE_API_CORRECTION_REPORT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/api/job.h"
#include "core/base/config_fields.h"
#include "core/base/json.h"
#include "core/motion/metrics/plausibility.h"

/// What came of a CorrectSpec: the "report" in the manifest of a job of kind "correct". It knows no
/// time and no attempt, so that a job that was interrupted has the same one.
namespace poise::api {

/// What only the simulation can say about a correction.
struct CorrectionScore {
  double residual_force_mean_bw = 0;  ///< [body weights] of the outer force, until the fall
  double residual_force_peak_bw = 0;
  double residual_torque_mean_nm = 0;  ///< [N m]
  double residual_torque_peak_nm = 0;
  double torque_saturation = 0;  ///< [0, 1] part of all joints and steps at their limit
  double completion = 0;         ///< [0, 1] part of the motion until it failed
  double reward_imitation = 0;   ///< [0, 1] mean until the fall
  double reward_normalised = 0;  ///< [0, 1] over the whole motion, 0 after a fall
  double reward_total = 0;       ///< [0, 1] with the residual's term, 0 after a fall
  double pose_error_rad = 0;     ///< mean angle over joints
  double pose_error_m = 0;       ///< mean distance over joints

  std::vector<base::Field> Fields();
};

/// All that is measured of what the body did.
struct CorrectionMeasures {
  motion::Plausibility plausibility;
  CorrectionScore score;
};

/// The authors' controller without learning on the source itself: the baseline.
struct ZeroPolicyReport {
  bool completed = false;
  CorrectionMeasures measures;
};

/// Mean over the variants after so much simulation; of a policy over variants that it did not learn
/// from.
struct RewardPoint {
  int64_t samples = 0;
  double reward_normalised = 0;
  double residual_force_mean_bw = 0;
  double residual_torque_mean_nm = 0;

  std::vector<base::Field> Fields();
};

struct CorrectedVariantReport {
  std::string file;  ///< of the result; empty when there is none (see error)
  int index = 0;
  uint64_t seed = 0;  ///< of this variant's own random stream
  /// No fall, and never far from its reference. False: the file shows the fall.
  bool completed = false;
  std::string effort;           ///< whose imitation was the best: instant | fast | full
  motion::Plausibility before;  ///< by the character's own bodies, like `after`
  std::optional<CorrectionMeasures> after;
  std::optional<JobError> error;  ///< why there is no correction: DIVERGED, OUT_OF_TIME
};

struct CorrectedClipReport {
  std::string name;
  int64_t samples = 0;  ///< simulated frames, and actions that a policy learned from
  /// Why no more was tried: finished (the effort was made) | max_seconds; of a policy that was
  /// learned also converged | max_samples.
  std::string stopped_by;
  std::optional<ZeroPolicyReport> zero_policy;  ///< absent when time was up before
  std::vector<RewardPoint> reward_curve;
  std::vector<CorrectedVariantReport> variants;
};

/// `before`, `after` and `zero_policy` are flat objects with the field names above.
base::Json ToJson(const ZeroPolicyReport& report);
base::Json ToJson(const CorrectedVariantReport& report);
base::Json ToJson(const CorrectedClipReport& report);
/// Errors: kInvalidArgument MALFORMED_REPORT.
StatusOr<ZeroPolicyReport> ZeroPolicyFromJson(const base::Json& json);
StatusOr<CorrectedVariantReport> CorrectedVariantFromJson(const base::Json& json);
StatusOr<CorrectedClipReport> CorrectedClipFromJson(const base::Json& json);

}  // namespace poise::api

#endif  // POISE_CORE_API_CORRECTION_REPORT_H_
