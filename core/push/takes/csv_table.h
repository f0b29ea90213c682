#ifndef POISE_CORE_PUSH_TAKES_CSV_TABLE_H_
#define POISE_CORE_PUSH_TAKES_CSV_TABLE_H_

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"

namespace poise::push {

/// A CSV file with one header line, comma separated and without quoting, in memory.
class CsvTable {
 public:
  /// Errors: kNotFound FILE_NOT_FOUND; kInvalidArgument MALFORMED_CSV (no header, a line with
  /// another number of cells, or one of `columns` missing).
  static StatusOr<CsvTable> Read(const std::filesystem::path& path,
                                 const std::vector<std::string>& columns);

  int num_rows() const { return static_cast<int>(cells_.size() / num_columns_); }
  /// `column` counts in the list given to Read.
  std::string_view text(int row, int column) const {
    return cells_[static_cast<size_t>(row) * num_columns_ + places_[column]];
  }
  /// NaN for what is no number.
  double number(int row, int column) const;
  int integer(int row, int column) const { return static_cast<int>(number(row, column)); }

 private:
  std::shared_ptr<const std::string> data_;
  size_t num_columns_ = 1;
  std::vector<int> places_;              // of the wanted columns
  std::vector<std::string_view> cells_;  // (rows, columns), views into *data_
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TAKES_CSV_TABLE_H_
