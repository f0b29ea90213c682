#include "client/cli/augment_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "client/cli/plausibility_text.h"
#include "client/cli/table.h"

namespace poise::cli {
namespace {

std::vector<std::string> Header() {
  std::vector<std::string> header = {"clip"};
  for (const Measure& measure : Measures()) {
    header.push_back(fmt::format("{} {}", measure.head, measure.unit));
  }
  return header;
}

std::vector<std::string> Row(std::string label, const motion::Plausibility& plausibility,
                             double divisor = 1) {
  std::vector<std::string> row = {std::move(label)};
  for (const Measure& measure : Measures()) {
    row.push_back(fmt::format("{:.{}f}", plausibility.*measure.value * measure.scale / divisor,
                              measure.decimals));
  }
  return row;
}

}  // namespace

base::Json VariantJson(const api::DeliveredVariant& variant, const std::string& source,
                       const std::string& file, const std::string& method) {
  base::Json json = {
      {"index", variant.index},     {"source", source},     {"file", file},
      {"seed", variant.seed},       {"method", method},     {"target_m", nullptr},
      {"reached_error_m", nullptr}, {"reachable", nullptr}, {"plausibility", nullptr}};
  if (variant.ik) {
    const motion::Vec3& target = variant.ik->target;
    json["target_m"] = {target.x(), target.y(), target.z()};
    json["reached_error_m"] = variant.ik->reached_error_m;
    json["reachable"] = variant.ik->reachable;
  }
  if (variant.plausibility) json["plausibility"] = motion::ToJson(*variant.plausibility);
  return json;
}

AugmentReport::AugmentReport(std::vector<Source> sources)
    : sources_(std::move(sources)), tallies_(sources_.size()) {}

void AugmentReport::Add(const api::DeliveredVariant& variant) {
  Tally& tally = tallies_[variant.source_index];
  ++tally.variants;
  if (variant.plausibility) {
    ++tally.assessed;
    for (const Measure& measure : Measures()) {
      const double value = *variant.plausibility.*measure.value;
      tally.sum.*measure.value += value;
      tally.worst.*measure.value = std::max(tally.worst.*measure.value, value);
    }
  }
  if (variant.ik) {
    ++ik_variants_;
    if (variant.ik->reachable) {
      ++reachable_;
      largest_error_m_ = std::max(largest_error_m_, variant.ik->reached_error_m);
    } else {
      unreachable_error_sum_m_ += variant.ik->reached_error_m;
    }
  }
}

std::string AugmentReport::Text() const {
  Table table(Header());
  for (size_t i = 0; i < sources_.size(); ++i) {
    const Tally& tally = tallies_[i];
    table.AddRow(sources_[i].plausibility
                     ? Row(sources_[i].name + ", source", *sources_[i].plausibility)
                     : std::vector{sources_[i].name + ", source"});
    if (tally.assessed == 0) continue;
    table.AddRow(
        Row(fmt::format("  {} variants, mean", tally.variants), tally.sum, tally.assessed));
    table.AddRow(Row("  worst", tally.worst));
  }
  std::string text = table.Text();
  if (reachable_ > 0) {
    text += fmt::format("\nIK: {} of {} targets within reach, missed by at most {:.2f} mm",
                        reachable_, ik_variants_, largest_error_m_ * 1000);
  }
  if (const int others = ik_variants_ - reachable_; others > 0) {
    text += fmt::format("\nIK: {} of {} targets out of reach, approached to {:.1f} cm on average",
                        others, ik_variants_, unreachable_error_sum_m_ / others * 100);
  }
  return text;
}

}  // namespace poise::cli
