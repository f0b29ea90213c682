#ifndef POISE_CORE_MOTION_IO_TEXT_SCANNER_H_
#define POISE_CORE_MOTION_IO_TEXT_SCANNER_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/status.h"

namespace poise::motion {

/// A short, printable quotation of what a file holds, for messages: 'OFSET', or "the end of the
/// file" for an empty one.
std::string Quoted(std::string_view found);

/// Text of a file as UTF-8: what is none is taken for Latin-1 (old motion files hold such bytes).
std::string ToUtf8(std::string_view text);

/// Same letters, in any case. ASCII only.
bool EqualsIgnoringCase(std::string_view a, std::string_view b);

/// Walks through a text file and knows its line, for the readers of text formats. Lines end in LF,
/// CRLF (mixed as they come) or CR alone. It allocates nothing but messages.
class TextScanner {
 public:
  /// `reason` is the reason of its errors ("MALFORMED_BVH"). `file` and `text` must outlive it.
  TextScanner(std::string_view file, std::string_view reason, std::string_view text);

  /// Moves to the next line that is not blank; false at the end of the text.
  bool NextLine();
  /// Next word of the current line, empty at its end.
  std::string_view NextWordOfLine();
  /// Next word, on whatever line; empty at the end of the text. A brace is a word of its own.
  std::string_view NextWord();
  /// What is left of the current line up to `stop`, without blanks around it.
  std::string_view RestOfLine(char stop = '\n');
  /// The same, left where it is.
  std::string_view PeekRestOfLine() const;
  /// Steps over `c` if it comes next on the line.
  void SkipCharacter(char c);

  /// Next word as a finite number. Errors: the scanner's reason; `what` names it ("OFFSET y").
  StatusOr<double> NextNumber(std::string_view what);
  /// Next word as an integer in [0, max].
  StatusOr<int64_t> NextCount(std::string_view what, int64_t max);
  /// Fills `row` from the rest of the line, which must hold exactly so many finite numbers, parted
  /// by blanks or, when `separator` is a comma, by commas. `what` names the row ("frame 12").
  Status ReadRow(std::span<double> row, std::string_view what, char separator = ' ');

  int line_number() const { return line_number_; }
  size_t bytes_left() const { return text_.size() - next_line_; }
  std::string_view file() const { return file_; }

  /// "kick.bvh: line 12: `problem`"
  Status Error(std::string_view problem) const;
  /// "kick.bvh: line 12: expected `expected`, found 'found'"
  Status Expected(std::string_view expected, std::string_view found) const;

 private:
  std::string_view file_, reason_, text_;
  char line_end_;
  size_t next_line_ = 0;   // where the line after the current one begins
  std::string_view rest_;  // unread part of the current line
  int line_number_ = 0;
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_TEXT_SCANNER_H_
