#ifndef POISE_CORE_LEARNING_NN_LEARNING_CURVE_H_
#define POISE_CORE_LEARNING_NN_LEARNING_CURVE_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"

namespace poise::learning {

/// What a training run measured, step by step: for people as a picture, for programs as CSV.
class LearningCurve {
 public:
  struct Row {
    int64_t step = 0;
    std::map<std::string, double> values;  ///< "reconstruction", "validation", ...; not all in all
    bool operator==(const Row&) const = default;
  };

  /// Steps must not go backwards.
  void Add(Row row) { rows_.push_back(std::move(row)); }
  const std::vector<Row>& rows() const { return rows_; }
  /// Every name that some row has, sorted.
  std::vector<std::string> Names() const;

  /// Columns: step, then Names(); empty where a row lacks a value. Doubles round-trip.
  std::string ToCsv() const;
  /// Inverse of ToCsv. Errors: kInvalidArgument MALFORMED_CURVE with the line.
  static StatusOr<LearningCurve> FromCsv(std::string_view csv);

  /// One small chart per name over the steps, the vertical axis logarithmic where all values are
  /// positive and span more than a decade.
  std::string ToSvg(std::string_view title) const;

 private:
  std::vector<Row> rows_;
};

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_LEARNING_CURVE_H_
