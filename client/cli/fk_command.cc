#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>

#include "client/cli/clip_input.h"
#include "client/cli/commands.h"
#include "client/cli/file_access.h"
#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Write where every joint is, as CSV.\n\n"
    "Forward kinematics of the frames that are asked for: columns frame,joint,x,y,z in metres, Y "
    "up, frames counted from 0. The tip of a bone that no joint ends is a row named JOINT_end.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise fk kick.bvh --frames 0,50 --out kick.csv\n"
    "  poise fk kick.bvh --frames 10-20         to standard output\n"
    "  poise fk kick.bvh --json                 one JSON object a row";

struct FkOptions {
  std::string file;
  std::string frames;
  std::string out;
  ReaderFlags reader;
};

Status BadFrames(const std::string& text, int num_frames) {
  return base::InvalidArgument(
      "BAD_FRAMES", "frames",
      fmt::format("--frames has '{}', expected frame numbers or ranges (0,50,60-70) from 0 to {}",
                  text, num_frames - 1));
}

// "50" -> 50, if it is a frame of the clip.
std::optional<int> ParseFrame(std::string_view text, int num_frames) {
  int frame = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  if (frame < 0 || frame >= num_frames) return std::nullopt;
  return frame;
}

// "0,50,60-70"; empty means all frames.
StatusOr<std::vector<int>> ParseFrames(const std::string& text, int num_frames) {
  std::vector<int> frames;
  const std::string list = text.empty() ? fmt::format("0-{}", num_frames - 1) : text;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    const std::string item = list.substr(begin, end - begin);
    const size_t dash = std::min(item.find('-'), item.size());
    const std::optional<int> first = ParseFrame(item.substr(0, dash), num_frames);
    const std::optional<int> last =
        dash == item.size() ? first : ParseFrame(item.substr(dash + 1), num_frames);
    if (!first || !last || *last < *first) return BadFrames(item, num_frames);
    for (int frame = *first; frame <= *last; ++frame) frames.push_back(frame);
    begin = end + 1;
  }
  return frames;
}

// Calls row(frame, name, position) for the joints and end sites of one frame.
template <typename Row>
void ForEachPoint(const motion::Clip& clip, int frame, motion::WorldPoses& poses, const Row& row) {
  motion::ForwardKinematics(clip, frame, 1, poses);
  for (int joint = 0; joint < clip.num_joints(); ++joint) {
    const motion::Joint& description = clip.skeleton()->joint(joint);
    row(frame, description.name, poses.position(0, joint));
    if (description.end_site) {
      row(frame, description.name + "_end", poses.Point(0, joint, *description.end_site));
    }
  }
}

// A name with a comma or a quote is quoted (RFC 4180).
std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string CsvRows(const motion::Clip& clip, const std::vector<int>& frames) {
  std::string csv = "frame,joint,x,y,z\n";
  motion::WorldPoses poses;
  for (const int frame : frames) {
    ForEachPoint(clip, frame, poses, [&](int number, const std::string& name, motion::Vec3 at) {
      csv += fmt::format("{},{},{:.6f},{:.6f},{:.6f}\n", number, CsvField(name), at.x(), at.y(),
                         at.z());
    });
  }
  return csv;
}

void PrintJsonRows(const motion::Clip& clip, const std::vector<int>& frames,
                   const Console& console) {
  motion::WorldPoses poses;
  for (const int frame : frames) {
    ForEachPoint(clip, frame, poses, [&](int number, const std::string& name, motion::Vec3 at) {
      console.PrintJson(
          {{"frame", number}, {"joint", name}, {"x", at.x()}, {"y", at.y()}, {"z", at.z()}});
    });
  }
}

Status RunFk(const FkOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const LoadedClip loaded, LoadClip(options.file, options.reader));
  const motion::Clip& clip = loaded.file.clip;
  POISE_ASSIGN_OR_RETURN(const std::vector<int> frames,
                         ParseFrames(options.frames, clip.num_frames()));
  if (options.out.empty() && console.json()) {
    PrintJsonRows(clip, frames, console);
    return absl::OkStatus();
  }
  const std::string csv = CsvRows(clip, frames);
  if (options.out.empty()) {
    fmt::print("{}", csv);
    return absl::OkStatus();
  }
  POISE_RETURN_IF_ERROR(WriteFile(options.out, csv));
  if (console.json()) {
    console.PrintJson({{"file", options.out}, {"frames", frames.size()}});
  } else {
    console.Note(fmt::format("{}: {} frames of {}", options.out, frames.size(), clip.name()));
  }
  return absl::OkStatus();
}

}  // namespace

Command AddFkCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<FkOptions>();
  CLI::App* command = app.add_subcommand("fk", kDescription);
  command->footer(kFooter);
  command->add_option("FILE", options->file, "Motion file")->type_name("")->required();
  command->add_option("--frames", options->frames, "Frames and ranges: 0,50,60-70 (default: all)")
      ->type_name("LIST");
  command->add_option("--out", options->out, "CSV file to write (default: standard output)")
      ->type_name("FILE");
  AddReaderFlags(*command, options->reader);
  AddJsonFlag(*command);
  return {command, [options, &console] { return RunFk(*options, console); }};
}

}  // namespace poise::cli
