#include "client/cli/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace poise::cli {
namespace {

// Characters on the screen: the bytes of UTF-8 that begin one.
size_t Width(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
}

std::string Line(const std::vector<std::string>& cells, const std::vector<size_t>& widths) {
  std::string line;
  for (size_t column = 0; column < cells.size(); ++column) {
    const std::string padding(widths[column] - Width(cells[column]), ' ');
    line += column == 0 ? cells[column] + padding : "  " + padding + cells[column];
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace

std::string Table::Text() const {
  std::vector<size_t> widths;
  for (const std::vector<std::string>& row : rows_) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t column = 0; column < row.size(); ++column) {
      widths[column] = std::max(widths[column], Width(row[column]));
    }
  }
  size_t total = 0;
  for (const size_t width : widths) total += width + 2;
  std::string text = Line(rows_.front(), widths) + "\n" + std::string(total - 2, '-');
  for (size_t row = 1; row < rows_.size(); ++row) text += "\n" + Line(rows_[row], widths);
  return text;
}

}  // namespace poise::cli
