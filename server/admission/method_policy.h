#ifndef POISE_SERVER_ADMISSION_METHOD_POLICY_H_
#define POISE_SERVER_ADMISSION_METHOD_POLICY_H_

#include "absl/time/time.h"

namespace poise::server {

/// How long calls of one method may take.
struct MethodPolicy {
  absl::Duration default_deadline;  ///< of a call that states none
  absl::Duration max_deadline;      ///< a later one is brought forward to this
};

/// The methods of this server. A training job may read one stream of variants all night.
struct MethodPolicies {
  MethodPolicy augment{.default_deadline = absl::Hours(1), .max_deadline = absl::Hours(24)};
  MethodPolicy upload{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};
  MethodPolicy download{.default_deadline = absl::Minutes(10), .max_deadline = absl::Hours(1)};
};

}  // namespace poise::server

#endif  // POISE_SERVER_ADMISSION_METHOD_POLICY_H_
