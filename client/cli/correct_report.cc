#include "client/cli/correct_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "client/cli/plausibility_text.h"
#include "client/cli/table.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {
namespace {

using api::CorrectedVariantReport;
using api::CorrectionMeasures;
using api::CorrectionScore;
using base::Json;
using motion::Plausibility;

// A measure of the simulation, as a column.
struct ScoreColumn {
  const char* head;
  double CorrectionScore::*value;
  double scale;  // from the field's unit to the column's
  int decimals;
  bool higher_is_better;
};

constexpr ScoreColumn kScores[] = {
    {"reward", &CorrectionScore::reward_normalised, 1, 3, true},
    {"force BW", &CorrectionScore::residual_force_mean_bw, 1, 3, false},
    {"peak BW", &CorrectionScore::residual_force_peak_bw, 1, 2, false},
    {"torque N m", &CorrectionScore::residual_torque_mean_nm, 1, 1, false},
    {"peak N m", &CorrectionScore::residual_torque_peak_nm, 1, 0, false},
    {"at limit %", &CorrectionScore::torque_saturation, 100, 1, false},
    {"pose rad", &CorrectionScore::pose_error_rad, 1, 3, false},
    {"pose cm", &CorrectionScore::pose_error_m, 100, 1, false},
};

/// How plausible the motions look, and beside it how they were imitated.
struct Tables {
  Tables() : looks(LooksHeader()), imitation(ImitationHeader()) {}

  static std::vector<std::string> LooksHeader() {
    std::vector<std::string> header = {"clip"};
    for (const Measure& measure : Measures()) {
      header.push_back(fmt::format("{} {}", measure.head, measure.unit));
    }
    return header;
  }
  static std::vector<std::string> ImitationHeader() {
    std::vector<std::string> header = {"imitation", "completed"};
    for (const ScoreColumn& score : kScores) header.emplace_back(score.head);
    return header;
  }

  void AddLooks(std::string label, const Plausibility& plausibility) {
    std::vector<std::string> row = {std::move(label)};
    for (const Measure& measure : Measures()) {
      row.push_back(
          fmt::format("{:.{}f}", plausibility.*measure.value * measure.scale, measure.decimals));
    }
    looks.AddRow(std::move(row));
  }
  void AddImitation(std::string label, std::string completed, const CorrectionScore& score) {
    std::vector<std::string> row = {std::move(label), std::move(completed)};
    for (const ScoreColumn& column : kScores) {
      row.push_back(fmt::format("{:.{}f}", score.*column.value * column.scale, column.decimals));
    }
    imitation.AddRow(std::move(row));
  }

  Table looks, imitation;
};

/// Mean and worst of a few variants.
struct Summary {
  Plausibility before;
  CorrectionMeasures mean, worst;
  int corrected = 0;
  int completed = 0;
};

void AddTo(CorrectionMeasures& mean, CorrectionMeasures& worst, const CorrectionMeasures& more,
           int count) {
  for (const Measure& measure : Measures()) {
    const double value = more.plausibility.*measure.value;
    mean.plausibility.*measure.value += value / count;
    double& bound = worst.plausibility.*measure.value;
    bound = std::max(bound, value);
  }
  for (const ScoreColumn& column : kScores) {
    const double value = more.score.*column.value;
    mean.score.*column.value += value / count;
    double& bound = worst.score.*column.value;
    bound = column.higher_is_better ? std::min(bound, value) : std::max(bound, value);
  }
}

Summary Summarise(const std::vector<CorrectedVariantReport>& variants) {
  Summary summary;
  summary.corrected = static_cast<int>(
      std::count_if(variants.begin(), variants.end(),
                    [](const CorrectedVariantReport& one) { return one.after.has_value(); }));
  bool first = true;
  for (const CorrectedVariantReport& variant : variants) {
    for (const Measure& measure : Measures()) {
      summary.before.*measure.value +=
          variant.before.*measure.value / static_cast<double>(variants.size());
    }
    summary.completed += variant.completed ? 1 : 0;
    if (!variant.after) continue;
    if (std::exchange(first, false)) summary.worst = *variant.after;
    AddTo(summary.mean, summary.worst, *variant.after, summary.corrected);
  }
  return summary;
}

void AddRows(const CorrectedClip& clip, Tables& tables) {
  const api::CorrectedClipReport& report = *clip.report;
  const size_t count = report.variants.size();
  const Summary summary = Summarise(report.variants);
  const std::string what = count == 1 ? "1 variant" : fmt::format("{} variants", count);
  tables.AddLooks(fmt::format("{}, {} before", clip.name, what), summary.before);
  if (summary.corrected > 0) tables.AddLooks("  after", summary.mean.plausibility);
  if (summary.corrected > 1) tables.AddLooks("  worst after", summary.worst.plausibility);
  if (report.zero_policy) {
    tables.AddLooks("  zero policy", report.zero_policy->measures.plausibility);
    tables.AddImitation(fmt::format("{}, zero policy", clip.name),
                        report.zero_policy->completed ? "1/1" : "0/1",
                        report.zero_policy->measures.score);
  }
  tables.AddImitation(fmt::format("{}, {}", clip.name, what),
                      fmt::format("{}/{}", summary.completed, count), summary.mean.score);
  if (summary.corrected > 1) tables.AddImitation("  worst", "", summary.worst.score);
}

std::string Remarks(const CorrectedClip& clip) {
  std::string text;
  for (const CorrectedVariantReport& variant : clip.report->variants) {
    if (variant.completed) continue;
    text += variant.error ? fmt::format("\n{}: variant {} could not be corrected: {}", clip.name,
                                        variant.index, variant.error->message)
                          : fmt::format(
                                "\n{}: variant {} was not completed: it failed after {:.0f} %; {} "
                                "shows it",
                                clip.name, variant.index, 100 * variant.after->score.completion,
                                variant.file);
  }
  if (clip.report->stopped_by == "max_seconds") {
    text += fmt::format("\n{}: stopped by {}; this is the best until then", clip.name,
                        clip.report->stopped_by);
  }
  return text;
}

// From the start of its first attempt to its end.
Json WallSeconds(const api::Job& job) {
  if (job.start_time == absl::InfiniteFuture() || job.end_time == absl::InfiniteFuture()) {
    return nullptr;
  }
  return absl::ToDoubleSeconds(job.end_time - job.start_time);
}

}  // namespace

base::Json CorrectedClipJson(const CorrectedClip& clip, const std::filesystem::path& folder) {
  Json json = {{"clip", clip.name},
               {"job", convert::JobName(clip.job.id)},
               {"state", api::JobStateName(clip.job.state)},
               {"wall_s", WallSeconds(clip.job)}};
  Json report = clip.report ? api::ToJson(*clip.report) : Json();
  for (const char* key : {"samples", "stopped_by", "zero_policy", "reward_curve", "variants"}) {
    json[key] = clip.report ? std::move(report[key]) : Json(nullptr);
  }
  if (clip.report) {
    for (Json& variant : json["variants"]) {
      if (variant["file"].is_string()) {
        variant["file"] = (folder / variant["file"].get<std::string>()).string();
      }
    }
  }
  json["error"] = nullptr;
  if (clip.job.error) {
    json["error"] = {{"code", absl::StatusCodeToString(clip.job.error->code)},
                     {"reason", clip.job.error->reason},
                     {"message", clip.job.error->message},
                     {"field", clip.job.error->field}};
  }
  return json;
}

std::string CorrectionText(const std::vector<CorrectedClip>& clips) {
  Tables tables;
  std::string remarks;
  for (const CorrectedClip& clip : clips) {
    if (!clip.report) continue;
    AddRows(clip, tables);
    remarks += Remarks(clip);
  }
  return tables.looks.Text() + "\n\n" + tables.imitation.Text() + remarks;
}

}  // namespace poise::cli
