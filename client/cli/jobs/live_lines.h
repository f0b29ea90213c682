#ifndef POISE_CLIENT_CLI_JOBS_LIVE_LINES_H_
#define POISE_CLIENT_CLI_JOBS_LIVE_LINES_H_

#include <string>
#include <string_view>

#include "absl/time/time.h"

namespace poise::cli {

/// A few lines on a terminal that are drawn over and over (on standard error); gone with the
/// object.
class LiveLines {
 public:
  LiveLines() = default;
  ~LiveLines();
  LiveLines(const LiveLines&) = delete;
  LiveLines& operator=(const LiveLines&) = delete;

  /// Draws `text` in the place of what is there, at most ten times a second; what comes between is
  /// left out unless `last`.
  void Show(std::string_view text, bool last = false);

  /// What fits a screen of this size: long lines are cut, and the last row says how many lines are
  /// left out. Counts characters of UTF-8, not bytes.
  static std::string Fit(std::string_view text, int columns, int rows);

 private:
  void Erase();

  int drawn_ = 0;  // lines on the screen
  absl::Time last_draw_ = absl::InfinitePast();
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_JOBS_LIVE_LINES_H_
