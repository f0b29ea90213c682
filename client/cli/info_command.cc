#include <fmt/format.h>

#include <memory>

#include "client/cli/clip_input.h"
#include "client/cli/commands.h"
#include "client/cli/plausibility_text.h"
#include "core/motion/metrics/plausibility.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Say what is in motion files.\n\n"
    "Format, length, skeleton, which joint plays which role, and how plausible the motion looks "
    "(foot skating, floor, self-penetration, acceleration, jerk). What the file does not state "
    "itself (unit, up axis, an AMC's frame rate) is detected from the size of the body; the notes "
    "say how.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise info kick.bvh\n"
    "  poise info clips/*.amc --json          one JSON object a line\n"
    "  poise info odd.bvh --unit cm --up z    where the detection is wrong\n"
    "  poise info odd.bvh --roles map.json    joints with names that Poise does not know";

struct InfoOptions {
  std::vector<std::string> files;
  ReaderFlags reader;
};

struct Report {
  LoadedClip loaded;
  StatusOr<motion::Plausibility> plausibility;
};

base::Json RolesJson(const Report& report) {
  base::Json roles = base::Json::object();
  const motion::Skeleton& skeleton = *report.loaded.file.clip.skeleton();
  for (int i = 0; i < motion::kNumRoles; ++i) {
    const auto role = static_cast<motion::JointRole>(i);
    if (!report.loaded.roles.has(role)) continue;
    roles[motion::RoleName(role)] = skeleton.joint(report.loaded.roles.joint(role)).name;
  }
  return roles;
}

base::Json ReportJson(const std::string& file, const Report& report) {
  const motion::Clip& clip = report.loaded.file.clip;
  const motion::SourceConvention& convention = report.loaded.file.convention;
  base::Json json = {{"file", file},
                     {"format", motion::ClipFormatName(convention.format)},
                     {"frames", clip.num_frames()},
                     {"fps", clip.frame_rate()},
                     {"duration_s", clip.duration()},
                     {"joints", clip.num_joints()},
                     {"unit_m", convention.unit_m},
                     {"up", UpAxisName(convention.up)},
                     {"roles", RolesJson(report)},
                     {"missing_roles", report.loaded.roles.missing()},
                     {"plausibility", nullptr},
                     {"notes", convention.notes}};
  if (report.plausibility.ok()) {
    json["plausibility"] = motion::ToJson(*report.plausibility);
  } else {
    json["notes"].push_back("plausibility: " + base::Message(report.plausibility.status()));
  }
  return json;
}

std::string RolesText(const Report& report) {
  const base::Json roles = RolesJson(report);
  std::string text;
  for (const auto& [role, joint] : roles.items()) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", role, joint.get<std::string>());
  }
  return text;
}

void PrintReport(const std::string& file, const Report& report, const Console& console) {
  const motion::Clip& clip = report.loaded.file.clip;
  const motion::SourceConvention& convention = report.loaded.file.convention;
  const auto line = [&](const char* label, const std::string& value) {
    console.Print(fmt::format("  {:<17} {}", label, value));
  };
  console.Print(file);
  line("format", motion::ClipFormatName(convention.format));
  line("frames", fmt::format("{} at {:.6g} fps, {:.2f} s", clip.num_frames(), clip.frame_rate(),
                             clip.duration()));
  line("joints", fmt::format("{}", clip.num_joints()));
  line("unit", fmt::format("{:.6g} m, {} up", convention.unit_m, UpAxisName(convention.up)));
  line("roles", RolesText(report));
  const std::vector<std::string> missing = report.loaded.roles.missing();
  line("missing roles", missing.empty() ? "none" : fmt::format("{}", fmt::join(missing, ", ")));
  if (report.plausibility.ok()) {
    for (const Measure& measure : Measures()) {
      line(measure.label, measure.Text(*report.plausibility));
    }
  } else {
    line("plausibility", base::Message(report.plausibility.status()));
  }
  for (const std::string& note : convention.notes) line("note", note);
}

Status RunInfo(const InfoOptions& options, const Console& console) {
  for (const std::string& file : options.files) {
    POISE_ASSIGN_OR_RETURN(LoadedClip loaded, LoadClip(file, options.reader));
    auto plausibility = motion::AssessPlausibility(loaded.file.clip, loaded.roles);
    const Report report{.loaded = std::move(loaded), .plausibility = std::move(plausibility)};
    if (console.json()) {
      console.PrintJson(ReportJson(file, report));
    } else {
      PrintReport(file, report, console);
    }
  }
  return absl::OkStatus();
}

}  // namespace

Command AddInfoCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", kDescription);
  command->footer(kFooter);
  command->add_option("FILE", options->files, "Motion files")->type_name("")->required();
  AddReaderFlags(*command, options->reader);
  AddJsonFlag(*command);
  return {command, [options, &console] { return RunInfo(*options, console); }};
}

}  // namespace poise::cli
