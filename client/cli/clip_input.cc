#include "client/cli/clip_input.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "client/cli/file_access.h"

namespace poise::cli {
namespace {

std::optional<double> ParseNumber(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

StatusOr<motion::ClipHints> ParseHints(const ReaderFlags& flags) {
  motion::ClipHints hints;
  if (!flags.unit.empty()) {
    POISE_ASSIGN_OR_RETURN(hints.unit_m, ParseUnit(flags.unit, "unit"));
  }
  if (!flags.up.empty()) {
    POISE_ASSIGN_OR_RETURN(hints.up, ParseUpAxis(flags.up, "up"));
  }
  if (!flags.fps.empty()) {
    POISE_ASSIGN_OR_RETURN(hints.frame_rate, ParseFrameRate(flags.fps, "fps"));
  }
  return hints;
}

StatusOr<motion::RoleOverrides> ReadRoleMap(const std::string& path) {
  if (path.empty()) return motion::RoleOverrides{};
  POISE_ASSIGN_OR_RETURN(const std::string json, ReadFile(path));
  auto overrides = motion::JointRoles::ParseOverrides(json);
  if (!overrides.ok()) return base::Annotate(overrides.status(), path, "roles");
  return overrides;
}

// A file whose format was given by hand.
StatusOr<motion::ClipFile> DecodeAs(const std::filesystem::path& path, const std::string& format,
                                    const motion::ClipHints& hints, const std::string& asf) {
  POISE_ASSIGN_OR_RETURN(const motion::ClipFormat parsed, motion::ParseClipFormat(format));
  POISE_ASSIGN_OR_RETURN(const std::string data, ReadFile(path));
  std::string skeleton_data;
  if (!asf.empty()) {
    POISE_ASSIGN_OR_RETURN(skeleton_data, ReadFile(asf));
  }
  return motion::DecodeClip(path.filename().string(), data, parsed, hints, skeleton_data);
}

}  // namespace

void AddReaderFlags(CLI::App& app, ReaderFlags& flags) {
  constexpr char kGroup[] = "What the file does not say (default: detect)";
  app.add_option("--unit", flags.unit, "Length unit of the file: m, cm, mm, inch or metres (0.056)")
      ->type_name("UNIT")
      ->group(kGroup);
  app.add_option("--up", flags.up, "Axis that points up in the file: y or z")
      ->type_name("AXIS")
      ->group(kGroup);
  app.add_option("--fps", flags.fps, "Frames per second of the file")
      ->type_name("RATE")
      ->group(kGroup);
  app.add_option("--asf", flags.asf, "Skeleton (ASF file) of an AMC file")
      ->type_name("FILE")
      ->group(kGroup);
  app.add_option("--roles", flags.roles,
                 "JSON file that maps joints by hand: {\"left_hip\": \"LeftUpLeg\", ...}")
      ->type_name("FILE")
      ->group(kGroup);
  app.add_option("--format", flags.format, "File format: bvh, amc, npz, cmu_text or deepmimic_json")
      ->type_name("NAME")
      ->group(kGroup);
}

StatusOr<LoadedClip> LoadClip(const std::filesystem::path& path, const ReaderFlags& flags) {
  POISE_ASSIGN_OR_RETURN(const motion::ClipHints hints, ParseHints(flags));
  POISE_ASSIGN_OR_RETURN(motion::RoleOverrides overrides, ReadRoleMap(flags.roles));
  auto file = flags.format.empty() ? motion::ReadClipFile(path, hints, flags.asf)
                                   : DecodeAs(path, flags.format, hints, flags.asf);
  POISE_RETURN_IF_ERROR(file.status());
  auto roles = motion::JointRoles::Detect(*file->clip.skeleton(), overrides);
  if (!roles.ok()) return base::Annotate(roles.status(), path.string());
  return LoadedClip{
      .file = *std::move(file), .roles = *std::move(roles), .role_overrides = std::move(overrides)};
}

StatusOr<double> ParseUnit(const std::string& text, const std::string& flag) {
  if (text == "m") return 1.0;
  if (text == "cm") return 0.01;
  if (text == "mm") return 0.001;
  if (text == "inch") return 0.0254;
  const std::optional<double> metres = ParseNumber(text);
  if (metres && *metres > 0) return *metres;
  return base::InvalidArgument(
      "BAD_UNIT", flag,
      fmt::format("--{} is '{}', expected m, cm, mm, inch or a positive number of metres", flag,
                  text));
}

StatusOr<motion::UpAxis> ParseUpAxis(const std::string& text, const std::string& flag) {
  if (text == "y" || text == "Y") return motion::UpAxis::kY;
  if (text == "z" || text == "Z") return motion::UpAxis::kZ;
  return base::InvalidArgument("BAD_UP_AXIS", flag,
                               fmt::format("--{} is '{}', expected y or z", flag, text));
}

const char* UpAxisName(motion::UpAxis up) { return up == motion::UpAxis::kY ? "y" : "z"; }

StatusOr<double> ParseFrameRate(const std::string& text, const std::string& flag) {
  const std::optional<double> rate = ParseNumber(text);
  if (rate && *rate > 0 && *rate <= 10000) return *rate;
  return base::InvalidArgument(
      "BAD_FRAME_RATE", flag,
      fmt::format("--{} is '{}', expected frames per second, above 0 and at most 10000", flag,
                  text));
}

}  // namespace poise::cli
