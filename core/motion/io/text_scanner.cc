#include "core/motion/io/text_scanner.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace poise::motion {
namespace {

constexpr size_t kLongestQuotation = 40;

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; }

void SkipBlanks(std::string_view& text) {
  size_t count = 0;
  while (count < text.size() && IsBlank(text[count])) ++count;
  text.remove_prefix(count);
}

bool IsValidUtf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const size_t length = lead < 0x80                   ? 1
                          : lead >= 0xc2 && lead < 0xe0 ? 2
                          : lead >= 0xe0 && lead < 0xf0 ? 3
                          : lead >= 0xf0 && lead < 0xf5 ? 4
                                                        : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    }
    if (length > 2) {  // overlong forms, surrogates and what lies beyond U+10FFFF
      const auto second = static_cast<unsigned char>(text[i + 1]);
      if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) ||
          (lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second > 0x8f)) {
        return false;
      }
    }
    i += length;
  }
  return true;
}

// Takes a number off the front of `text`; nullopt when there is none.
std::optional<double> TakeNumber(std::string_view& text) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    value = std::strtod(std::string(begin, stop).c_str(), nullptr);  // 0 or infinity
  }
  text.remove_prefix(stop - text.data());
  return value;
}

}  // namespace

std::string Quoted(std::string_view found) {
  if (found.empty()) return "nothing";
  std::string text = "'";
  for (const char c : found.substr(0, kLongestQuotation)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      text += c;
    } else {
      text += fmt::format("\\x{:02x}", byte);
    }
  }
  return text + (found.size() > kLongestQuotation ? "...'" : "'");
}

std::string ToUtf8(std::string_view text) {
  if (IsValidUtf8(text)) return std::string(text);
  std::string utf8;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xc0 | (byte >> 6));
      utf8 += static_cast<char>(0x80 | (byte & 0x3f));
    }
  }
  return utf8;
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  for (size_t i = 0; i < a.size(); ++i) {
    if (lower(a[i]) != lower(b[i])) return false;
  }
  return true;
}

TextScanner::TextScanner(std::string_view file, std::string_view reason, std::string_view text)
    : file_(file),
      reason_(reason),
      text_(text),
      line_end_(text.find('\n') == std::string_view::npos ? '\r' : '\n') {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

bool TextScanner::NextLine() {
  while (next_line_ < text_.size()) {
    const size_t end = std::min(text_.find(line_end_, next_line_), text_.size());
    rest_ = text_.substr(next_line_, end - next_line_);
    next_line_ = std::min(end + 1, text_.size());
    ++line_number_;
    SkipBlanks(rest_);
    if (!rest_.empty()) return true;
  }
  rest_ = {};
  return false;
}

std::string_view TextScanner::NextWordOfLine() {
  SkipBlanks(rest_);
  size_t length = 0;
  while (length < rest_.size() && !IsBlank(rest_[length])) ++length;
  const std::string_view word = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return word;
}

std::string_view TextScanner::NextWord() {
  SkipBlanks(rest_);
  if (rest_.empty() && !NextLine()) return {};
  const auto is_brace = [](char c) { return c == '{' || c == '}'; };
  size_t length = is_brace(rest_.front()) ? 1 : 0;
  if (length == 0) {
    while (length < rest_.size() && !IsBlank(rest_[length]) && !is_brace(rest_[length])) ++length;
  }
  const std::string_view word = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return word;
}

std::string_view TextScanner::RestOfLine(char stop) {
  std::string_view text = rest_.substr(0, rest_.find(stop));
  rest_.remove_prefix(text.size());
  SkipBlanks(text);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view TextScanner::PeekRestOfLine() const {
  TextScanner ahead = *this;
  return ahead.RestOfLine();
}

void TextScanner::SkipCharacter(char c) {
  if (rest_.starts_with(c)) rest_.remove_prefix(1);
}

StatusOr<double> TextScanner::NextNumber(std::string_view what) {
  const std::string_view word = NextWord();
  std::string_view rest = word;
  const std::optional<double> value = TakeNumber(rest);
  if (!value || !rest.empty() || !std::isfinite(*value)) {
    return Expected(fmt::format("a finite number for {}", what), word);
  }
  return *value;
}

StatusOr<int64_t> TextScanner::NextCount(std::string_view what, int64_t max) {
  const std::string_view word = NextWord();
  int64_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size() || value < 0 || value > max) {
    return Expected(fmt::format("{}: an integer from 0 to {}", what, max), word);
  }
  return value;
}

Status TextScanner::ReadRow(std::span<double> row, std::string_view what, char separator) {
  for (size_t i = 0; i < row.size(); ++i) {
    SkipBlanks(rest_);
    if (i > 0 && separator == ',' && rest_.starts_with(',')) {
      rest_.remove_prefix(1);
      SkipBlanks(rest_);
    }
    if (rest_.empty()) {
      return Error(fmt::format("{} has {} numbers, expected {}", what, i, row.size()));
    }
    const std::string_view before = rest_;
    const std::optional<double> value = TakeNumber(rest_);
    const bool ends = rest_.empty() || IsBlank(rest_.front()) || rest_.front() == separator;
    if (!value || !ends || !std::isfinite(*value)) {
      const size_t stop = before.find_first_of(separator == ',' ? ", \t\r" : " \t\r");
      return Expected(fmt::format("a finite number at place {} of {}", i + 1, what),
                      before.substr(0, stop));
    }
    row[i] = *value;
  }
  SkipBlanks(rest_);
  if (!rest_.empty()) {
    return Error(fmt::format("{} has more than the expected {} numbers: {} is left", what,
                             row.size(), Quoted(rest_)));
  }
  return absl::OkStatus();
}

Status TextScanner::Error(std::string_view problem) const {
  return base::InvalidArgument(reason_, "",
                               fmt::format("{}: line {}: {}", file_, line_number_, problem));
}

Status TextScanner::Expected(std::string_view expected, std::string_view found) const {
  return Error(fmt::format(
      "expected {}, found {}", expected,
      found.empty() && next_line_ >= text_.size() ? "the end of the file" : Quoted(found)));
}

}  // namespace poise::motion
