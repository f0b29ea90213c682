#include "core/push/takes/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>

namespace poise::push {
namespace {

std::vector<std::string_view> SplitLine(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

// The next line without its end; empty views only for blank lines and at the end of the text.
std::string_view TakeLine(std::string_view& text) {
  const size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace

StatusOr<CsvTable> CsvTable::Read(const std::filesystem::path& path,
                                  const std::vector<std::string>& columns) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return base::NotFound("FILE_NOT_FOUND", "", path.string() + " cannot be read");
  const auto malformed = [&](int line, const std::string& problem) {
    return base::InvalidArgument("MALFORMED_CSV", "",
                                 fmt::format("{}: line {}: {}", path.string(), line, problem));
  };
  CsvTable table;
  table.data_ = std::make_shared<const std::string>(std::istreambuf_iterator<char>(file),
                                                    std::istreambuf_iterator<char>());
  std::string_view rest = *table.data_;
  const std::vector<std::string_view> header = SplitLine(TakeLine(rest));
  table.num_columns_ = header.size();
  for (const std::string& column : columns) {
    const auto found = std::find(header.begin(), header.end(), column);
    if (found == header.end()) return malformed(1, fmt::format("no column '{}'", column));
    table.places_.push_back(static_cast<int>(found - header.begin()));
  }
  for (int line = 2; !rest.empty(); ++line) {
    const std::vector<std::string_view> cells = SplitLine(TakeLine(rest));
    if (cells.size() != header.size()) {
      return malformed(line, fmt::format("{} cells, expected {}", cells.size(), header.size()));
    }
    table.cells_.insert(table.cells_.end(), cells.begin(), cells.end());
  }
  return table;
}

double CsvTable::number(int row, int column) const {
  const std::string_view cell = text(row, column);
  double value = 0;
  const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = error == std::errc() && stop == cell.data() + cell.size();
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace poise::push
