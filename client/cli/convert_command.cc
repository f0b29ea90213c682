#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "client/cli/clip_input.h"
#include "client/cli/commands.h"
#include "core/motion/editing/align.h"
#include "core/motion/editing/mirror.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/editing/resample.h"
#include "core/motion/editing/retarget.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Turn a motion file of any format into BVH, with edits on the way.\n\n"
    "A BVH file keeps its unit, up axis and channel order; other formats come out in centimetres, "
    "Y up, channels Z X Y. The edits are done in this order: fewer joints, another body, left and "
    "right swapped, moved to the origin, another frame rate.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise convert kick.amc kick.bvh\n"
    "  poise convert kick.amc kick30.bvh --to-fps 30 --to-unit m\n"
    "  poise convert kick.bvh kick_left.bvh --mirror --align\n"
    "  poise convert walk.bvh robot_walk.bvh --retarget robot.bvh\n"
    "  poise convert walk.npz walk.bvh --to-up z";

struct ConvertOptions {
  std::string in;
  std::string out;
  std::string reduce;    // a mode; empty = all joints
  std::string retarget;  // a file with the other body
  bool mirror = false;
  bool align = false;
  std::string to_fps;
  std::string to_unit;
  std::string to_up;
  ReaderFlags reader;
};

Status CheckOptions(const ConvertOptions& options) {
  const std::filesystem::path out = options.out;
  if (out.extension() != ".bvh" && out.extension() != ".BVH") {
    return base::InvalidArgument(
        "UNSUPPORTED_OUTPUT", "out",
        fmt::format("{}: Poise writes BVH; give a name that ends in .bvh", out.string()));
  }
  if (!options.reduce.empty() && options.reduce != "reference" && options.reduce != "composed") {
    return base::InvalidArgument(
        "BAD_REDUCTION", "reduce",
        fmt::format("--reduce is '{}', expected reference or composed", options.reduce));
  }
  return absl::OkStatus();
}

// Leaves the 16 joints of the required roles. The channels of the file no longer fit.
Status Reduce(const std::string& mode_name, LoadedClip& loaded) {
  const auto mode = mode_name == "composed" ? motion::ReductionMode::kComposed
                                            : motion::ReductionMode::kReference;
  POISE_ASSIGN_OR_RETURN(loaded.file.clip,
                         motion::ReduceToRoles(loaded.file.clip, loaded.roles, mode));
  loaded.file.convention.channels.clear();
  motion::RoleOverrides kept;
  for (const auto& [role, joint] : loaded.role_overrides) {
    if (loaded.file.clip.skeleton()->Find(joint)) kept[role] = joint;
  }
  POISE_ASSIGN_OR_RETURN(loaded.roles,
                         motion::JointRoles::Detect(*loaded.file.clip.skeleton(), kept));
  return absl::OkStatus();
}

// Puts the motion on the body of another file, which also says how to write it.
Status RetargetTo(const std::string& path, LoadedClip& loaded) {
  POISE_ASSIGN_OR_RETURN(LoadedClip target, LoadClip(path, {}));
  POISE_ASSIGN_OR_RETURN(
      loaded.file.clip,
      motion::Retarget(loaded.file.clip, loaded.roles, target.file.clip.skeleton(), target.roles,
                       {.target_reference = &target.file.clip}));
  loaded.roles = std::move(target.roles);
  loaded.file.convention = std::move(target.file.convention);
  return absl::OkStatus();
}

Status Edit(const ConvertOptions& options, LoadedClip& loaded) {
  motion::Clip& clip = loaded.file.clip;
  if (!options.reduce.empty()) POISE_RETURN_IF_ERROR(Reduce(options.reduce, loaded));
  if (!options.retarget.empty()) POISE_RETURN_IF_ERROR(RetargetTo(options.retarget, loaded));
  if (options.mirror) {
    POISE_ASSIGN_OR_RETURN(clip, motion::Mirror(clip, loaded.roles));
  }
  if (options.align) {
    POISE_ASSIGN_OR_RETURN(clip, motion::Align(clip, loaded.roles));
  }
  if (!options.to_fps.empty()) {
    POISE_ASSIGN_OR_RETURN(const double rate, ParseFrameRate(options.to_fps, "to-fps"));
    POISE_ASSIGN_OR_RETURN(clip, motion::Resample(clip, rate));
  }
  return absl::OkStatus();
}

// How to write: as the source if that was BVH, but for what the flags ask.
StatusOr<motion::SourceConvention> OutputConvention(const motion::SourceConvention& source,
                                                    const ConvertOptions& options) {
  motion::SourceConvention convention;
  convention.unit_m = 0.01;
  if (source.format == motion::ClipFormat::kBvh) convention = source;
  if (!options.to_unit.empty()) {
    POISE_ASSIGN_OR_RETURN(convention.unit_m, ParseUnit(options.to_unit, "to-unit"));
  }
  if (!options.to_up.empty()) {
    POISE_ASSIGN_OR_RETURN(const motion::UpAxis up, ParseUpAxis(options.to_up, "to-up"));
    // Whoever wants Z up wants a rest pose that stands in it too.
    if (up != convention.up) convention.rest_pose_turned = up == motion::UpAxis::kZ;
    convention.up = up;
  }
  return convention;
}

Status RunConvert(const ConvertOptions& options, const Console& console) {
  POISE_RETURN_IF_ERROR(CheckOptions(options));
  POISE_ASSIGN_OR_RETURN(LoadedClip loaded, LoadClip(options.in, options.reader));
  const std::vector<std::string> notes = loaded.file.convention.notes;
  POISE_RETURN_IF_ERROR(Edit(options, loaded));
  POISE_ASSIGN_OR_RETURN(const motion::SourceConvention convention,
                         OutputConvention(loaded.file.convention, options));
  const motion::Clip& clip = loaded.file.clip;
  POISE_RETURN_IF_ERROR(motion::WriteBvhFile(options.out, clip, convention));
  if (console.json()) {
    console.PrintJson({{"file", options.out},
                       {"format", "bvh"},
                       {"frames", clip.num_frames()},
                       {"fps", clip.frame_rate()},
                       {"joints", clip.num_joints()},
                       {"unit_m", convention.unit_m},
                       {"up", UpAxisName(convention.up)},
                       {"notes", notes}});
    return absl::OkStatus();
  }
  for (const std::string& note : notes) console.Note("note: " + note);
  console.Print(fmt::format("{}: {} frames at {:.6g} fps, {} joints, unit {:.6g} m, {} up",
                            options.out, clip.num_frames(), clip.frame_rate(), clip.num_joints(),
                            convention.unit_m, UpAxisName(convention.up)));
  return absl::OkStatus();
}

void AddEditFlags(CLI::App& command, ConvertOptions& options) {
  command
      .add_option("--reduce", options.reduce,
                  "Keep the 16 joints of MotionAug; how to treat turns of the others: composed "
                  "(passed on) or reference (lost, as in its program)")
      ->type_name("MODE");
  command
      .add_option("--retarget", options.retarget,
                  "Put the motion on the body in this motion file, written as that file is")
      ->type_name("FILE");
  command.add_flag("--mirror", options.mirror, "Swap left and right");
  command.add_flag("--align", options.align, "Move the start to the origin, facing +Z");
  command.add_option("--to-fps", options.to_fps, "Resample to this many frames per second")
      ->type_name("RATE");
  command.add_option("--to-unit", options.to_unit, "Write lengths in m, cm, mm, inch or metres")
      ->type_name("UNIT");
  command.add_option("--to-up", options.to_up, "Write with this axis up: y or z")
      ->type_name("AXIS");
}

}  // namespace

Command AddConvertCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = app.add_subcommand("convert", kDescription);
  command->footer(kFooter);
  command->add_option("IN", options->in, "Motion file")->type_name("")->required();
  command->add_option("OUT", options->out, "BVH file to write")->type_name("")->required();
  AddEditFlags(*command, *options);
  AddReaderFlags(*command, options->reader);
  AddJsonFlag(*command);
  return {command, [options, &console] { return RunConvert(*options, console); }};
}

}  // namespace poise::cli
