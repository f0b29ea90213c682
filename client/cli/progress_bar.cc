#include "client/cli/progress_bar.h"

#include <fmt/format.h>

#include <cstdio>

#include "absl/time/clock.h"

namespace poise::cli {
namespace {

constexpr int kBarWidth = 30;
constexpr char kEraseLine[] = "\r\x1b[K";

}  // namespace

ProgressBar::ProgressBar(Style style, int64_t total, std::string unit)
    : style_(style), total_(total), unit_(std::move(unit)), start_(absl::Now()) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "{}", kEraseLine);
}

void ProgressBar::Update(int64_t done) {
  if (style_ == Style::kBar) DrawBar(done);
  if (style_ == Style::kLines) DrawLine(done);
}

std::string ProgressBar::Text(int64_t done, int64_t total, const std::string& unit,
                              absl::Duration elapsed) {
  const int filled = total > 0 ? static_cast<int>(done * kBarWidth / total) : 0;
  const double seconds = absl::ToDoubleSeconds(elapsed);
  std::string text = fmt::format("[{}{}]  {}/{} {}", std::string(filled, '#'),
                                 std::string(kBarWidth - filled, '.'), done, total, unit);
  if (done > 0 && seconds > 0) {
    const double rate = done / seconds;
    const int64_t left = static_cast<int64_t>((total - done) / rate + 0.5);
    text +=
        fmt::format("  {:.{}f}/s  {}:{:02} left", rate, rate < 10 ? 1 : 0, left / 60, left % 60);
  }
  return text;
}

void ProgressBar::DrawBar(int64_t done) {
  const absl::Time now = absl::Now();
  if (done < total_ && now - last_draw_ < absl::Milliseconds(50)) return;
  last_draw_ = now;
  fmt::print(stderr, "{}{}", kEraseLine, Text(done, total_, unit_, now - start_));
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::DrawLine(int64_t done) {
  const int64_t tenth = total_ > 0 ? done * 10 / total_ : 0;
  if (tenth == last_tenth_) return;
  last_tenth_ = tenth;
  fmt::print(stderr, "{} of {} {}\n", done, total_, unit_);
}

}  // namespace poise::cli
