#ifndef POISE_CLIENT_CLI_PROGRESS_BAR_H_
#define POISE_CLIENT_CLI_PROGRESS_BAR_H_

#include <cstdint>
#include <string>

#include "absl/time/time.h"

namespace poise::cli {

/// How far a long command is: on a terminal one line that is redrawn, elsewhere a plain line every
/// tenth of the way, on standard error.
class ProgressBar {
 public:
  enum class Style { kNone, kBar, kLines };

  /// `unit` is what is counted: "variants".
  ProgressBar(Style style, int64_t total, std::string unit);
  /// Takes an unfinished bar off the screen.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Update(int64_t done);

  /// "[#####.....]  10/20 variants  52/s  0:01 left"
  static std::string Text(int64_t done, int64_t total, const std::string& unit,
                          absl::Duration elapsed);

 private:
  void DrawBar(int64_t done);
  void DrawLine(int64_t done);

  const Style style_;
  const int64_t total_;
  const std::string unit_;
  const absl::Time start_;
  absl::Time last_draw_ = absl::InfinitePast();
  int64_t last_tenth_ = 0;
  bool drawn_ = false;
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_PROGRESS_BAR_H_
