#include "client/cli/jobs/live_lines.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "absl/time/clock.h"

namespace poise::cli {
namespace {

constexpr absl::Duration kShortestInterval = absl::Milliseconds(100);

struct Screen {
  int columns = 80;
  int rows = 24;
};

Screen ScreenSize() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
    return {};
  }
  return {size.ws_col, size.ws_row};
}

bool BeginsCharacter(char byte) { return (byte & 0xC0) != 0x80; }

std::string_view Cut(std::string_view line, int columns) {
  int width = 0;
  for (size_t i = 0; i < line.size(); ++i) {
    if (BeginsCharacter(line[i]) && ++width > columns) return line.substr(0, i);
  }
  return line;
}

}  // namespace

LiveLines::~LiveLines() { Erase(); }

void LiveLines::Show(std::string_view text, bool last) {
  const absl::Time now = absl::Now();
  if (!last && now - last_draw_ < kShortestInterval) return;
  last_draw_ = now;
  const Screen screen = ScreenSize();
  // The row below the text stays free, for the cursor.
  const std::string fitting = Fit(text, screen.columns - 1, screen.rows - 1);
  Erase();
  fmt::print(stderr, "{}\n", fitting);
  std::fflush(stderr);
  drawn_ = 1 + static_cast<int>(std::count(fitting.begin(), fitting.end(), '\n'));
}

void LiveLines::Erase() {
  if (drawn_ > 0) fmt::print(stderr, "\x1b[{}A\r\x1b[J", drawn_);
  drawn_ = 0;
}

std::string LiveLines::Fit(std::string_view text, int columns, int rows) {
  std::vector<std::string_view> lines;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(Cut(text.substr(begin, end - begin), columns));
    begin = end + 1;
  }
  std::string more;
  if (static_cast<int>(lines.size()) > rows) {
    const size_t shown = std::max(rows - 1, 0);
    more = fmt::format("... and {} more", lines.size() - shown);
    lines.resize(shown);
    lines.push_back(more);
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace poise::cli
