// Draws motion files as a sheet of figures:
//   poise_draw_motion [--overlay] [--moments N] OUT.svg CLIP...

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "core/motion/io/clip_file.h"
#include "samples/draw/figure_sheet.h"

namespace poise::samples {
namespace {

Status Draw(const SheetLayout& layout, const char* out, char** first, char** last) {
  std::vector<motion::Clip> clips;
  for (; first != last; ++first) {
    POISE_ASSIGN_OR_RETURN(motion::ClipFile file, motion::ReadClipFile(*first));
    clips.push_back(std::move(file.clip));
  }
  POISE_ASSIGN_OR_RETURN(const std::string svg, DrawSheet(clips, layout));
  std::ofstream file(out, std::ios::binary);
  file << svg;
  file.close();
  if (file.good()) return absl::OkStatus();
  return base::FailedPrecondition("CANNOT_WRITE", "", fmt::format("{}: cannot be written", out));
}

}  // namespace
}  // namespace poise::samples

int main(int argc, char** argv) {
  poise::samples::SheetLayout layout;
  int next = 1;
  for (; next < argc && std::string_view(argv[next]).starts_with("--"); ++next) {
    const std::string_view flag = argv[next];
    if (flag == "--overlay") {
      layout.overlay = true;
    } else if (flag == "--moments" && next + 1 < argc) {
      layout.moments = std::atoi(argv[++next]);
    } else {
      break;
    }
  }
  if (argc - next < 2 || std::string_view(argv[next]).starts_with("--")) {
    fmt::print(stderr, "usage: poise_draw_motion [--overlay] [--moments N] OUT.svg CLIP...\n");
    return 2;
  }
  const poise::Status status =
      poise::samples::Draw(layout, argv[next], argv + next + 1, argv + argc);
  if (!status.ok()) {
    fmt::print(stderr, "{}\n", poise::base::Message(status));
    return 1;
  }
  return 0;
}
