#include "core/learning/nn/learning_curve.h"

#include <fmt/format.h>

#include <set>

#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"

namespace poise::learning {

std::vector<std::string> LearningCurve::Names() const {
  std::set<std::string> names;
  for (const Row& row : rows_) {
    for (const auto& [name, value] : row.values) names.insert(name);
  }
  return {names.begin(), names.end()};
}

std::string LearningCurve::ToCsv() const {
  const std::vector<std::string> names = Names();
  std::string csv = "step";
  for (const std::string& name : names) csv += "," + name;
  csv += "\n";
  for (const Row& row : rows_) {
    csv += fmt::format("{}", row.step);
    for (const std::string& name : names) {
      const auto found = row.values.find(name);
      csv += found == row.values.end() ? "," : fmt::format(",{}", found->second);
    }
    csv += "\n";
  }
  return csv;
}

StatusOr<LearningCurve> LearningCurve::FromCsv(std::string_view csv) {
  const auto malformed = [](size_t line) {
    return base::InvalidArgument("MALFORMED_CURVE", "",
                                 fmt::format("line {} is no row of a learning curve", line + 1));
  };
  std::vector<std::string> lines = absl::StrSplit(std::string(csv), '\n');
  if (lines.size() > 1 && lines.back().empty()) lines.pop_back();
  const std::vector<std::string> names = absl::StrSplit(lines[0], ',');
  if (names[0] != "step") return malformed(0);
  LearningCurve curve;
  for (size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> cells = absl::StrSplit(lines[i], ',');
    Row row;
    if (cells.size() != names.size() || !absl::SimpleAtoi(cells[0], &row.step)) return malformed(i);
    for (size_t k = 1; k < cells.size(); ++k) {
      if (cells[k].empty()) continue;
      if (!absl::SimpleAtod(cells[k], &row.values[names[k]])) return malformed(i);
    }
    curve.Add(std::move(row));
  }
  return curve;
}

}  // namespace poise::learning
