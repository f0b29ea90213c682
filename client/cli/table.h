#ifndef POISE_CLIENT_CLI_TABLE_H_
#define POISE_CLIENT_CLI_TABLE_H_

#include <string>
#include <vector>

namespace poise::cli {

/// Text in columns: the first column to the left, the others to the right, two spaces between.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : rows_{std::move(header)} {}

  /// `cells` may be shorter than the header.
  void AddRow(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  /// The header, a rule and the rows, without a line end after the last.
  std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_TABLE_H_
