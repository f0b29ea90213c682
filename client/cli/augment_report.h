#ifndef POISE_CLIENT_CLI_AUGMENT_REPORT_H_
#define POISE_CLIENT_CLI_AUGMENT_REPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "core/api/augment_spec.h"
#include "core/base/json.h"
#include "core/motion/metrics/plausibility.h"

namespace poise::cli {

/// One variant as a JSON object: index source file seed method target_m reached_error_m reachable
/// plausibility. What a method without IK does not tell is null.
base::Json VariantJson(const api::DeliveredVariant& variant, const std::string& source,
                       const std::string& file, const std::string& method);

/// Gathers variants into a table that compares their plausibility with that of their sources.
class AugmentReport {
 public:
  struct Source {
    std::string name;
    std::optional<motion::Plausibility> plausibility;
  };

  explicit AugmentReport(std::vector<Source> sources);

  void Add(const api::DeliveredVariant& variant);

  /// Per source three rows: the source, the variants' mean and the worst of them; below it how many
  /// IK targets lay within reach and how near the joint came to the others.
  std::string Text() const;

 private:
  struct Tally {
    int variants = 0;
    int assessed = 0;
    motion::Plausibility sum;
    motion::Plausibility worst;
  };

  std::vector<Source> sources_;
  std::vector<Tally> tallies_;  // (sources)
  int ik_variants_ = 0;
  int reachable_ = 0;
  double largest_error_m_ = 0;          // where the target was reachable
  double unreachable_error_sum_m_ = 0;  // where it was not
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_AUGMENT_REPORT_H_
