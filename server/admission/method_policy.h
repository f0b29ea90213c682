#ifndef POISE_SERVER_ADMISSION_METHOD_POLICY_H_
#define POISE_SERVER_ADMISSION_METHOD_POLICY_H_

#include <algorithm>

#include "absl/time/time.h"

namespace poise::server {

/// Whose places a call takes while it is at work. What waits takes no thread, so it is counted
/// apart; and watchers, however many, leave room for the workers, without whom jobs would be lost.
enum class Place { kWork, kWatch, kWorker };

/// How long calls of one method may take, and what place.
struct MethodPolicy {
  absl::Duration default_deadline;  ///< of a call that states none
  absl::Duration max_deadline;      ///< a later one is brought forward to this
  Place place = Place::kWork;
};

/// The methods of this server. A training job may read one stream of variants all night.
struct MethodPolicies {
  MethodPolicy augment{.default_deadline = absl::Hours(1), .max_deadline = absl::Hours(24)};
  MethodPolicy predict{.default_deadline = absl::Seconds(30), .max_deadline = absl::Minutes(5)};
  /// As long as somebody moves before a camera.
  MethodPolicy predict_stream{.default_deadline = absl::Hours(1), .max_deadline = absl::Hours(24)};
  MethodPolicy push{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};
  MethodPolicy upload{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};
  MethodPolicy get_upload{.default_deadline = absl::Minutes(1), .max_deadline = absl::Minutes(10)};
  MethodPolicy download{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};
  /// Calls of JobService and Operations that answer at once.
  MethodPolicy job{.default_deadline = absl::Seconds(30), .max_deadline = absl::Minutes(5)};
  /// A watch that ends by this is to be joined again.
  MethodPolicy watch{
      .default_deadline = absl::Hours(1), .max_deadline = absl::Hours(1), .place = Place::kWatch};
  MethodPolicy job_result{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};
  MethodPolicy wait_operation{
      .default_deadline = absl::Minutes(5), .max_deadline = absl::Hours(1), .place = Place::kWatch};
  /// All of ModelService and DataService: they read and write whole files.
  MethodPolicy model{.default_deadline = absl::Minutes(2), .max_deadline = absl::Minutes(10)};
  MethodPolicy data{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};
  /// All of WorkerService: no flood of other calls may keep a worker from its lease.
  MethodPolicy worker{.default_deadline = absl::Minutes(1),
                      .max_deadline = absl::Minutes(5),
                      .place = Place::kWorker};
  MethodPolicy admin{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};

  /// The longest of all.
  absl::Duration longest() const {
    return std::max({augment.max_deadline, predict.max_deadline, predict_stream.max_deadline,
                     push.max_deadline, upload.max_deadline, download.max_deadline,
                     job.max_deadline, watch.max_deadline, job_result.max_deadline,
                     wait_operation.max_deadline, model.max_deadline, data.max_deadline,
                     worker.max_deadline, admin.max_deadline});
  }
};

}  // namespace poise::server

#endif  // POISE_SERVER_ADMISSION_METHOD_POLICY_H_
