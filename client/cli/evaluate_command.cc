#include <fmt/format.h>

#include <memory>
#include <utility>

#include "client/cli/commands.h"
#include "client/cli/table.h"
#include "core/motion/dataset/clip_folder.h"
#include "core/motion/distribution/compare_sets.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Measure what was made or predicted, beside what it should be like.";
constexpr char kSynthesisDescription[] =
    "Hold a folder of made motions against the clips that they were made from.\n\n"
    "Whether they come from the same distribution (unbiased MMD with the p-value of a permutation "
    "test), how near the nearest one is to each reference motion (exact DTW), how much they differ "
    "among themselves and from the training clips, how fast they move, how much their feet skate, "
    "and how many are oddly short or long. With --hold-out the reference is that actor, whom the "
    "motions were not made from; without, all clips are both. Needs no server.";
constexpr char kSynthesisFooter[] =
    "Examples:\n"
    "  poise evaluate synthesis made/ --data ~/hdm05 --class kick --hold-out tr\n"
    "  poise evaluate synthesis made/ --data ~/hdm05 --class kick --hold-out tr --json";

struct EvaluateOptions {
  std::string made;
  std::string data;
  std::string action_class;
  std::string hold_out;
  motion::CompareConfig compare;
  uint64_t seed = 0;
};

StatusOr<motion::MotionFeatures> Describe(const motion::Clip& clip) {
  const auto named = [&](const Status& status) {
    return base::Annotate(status, fmt::format("clip '{}'", clip.name()));
  };
  const auto roles = motion::JointRoles::Detect(*clip.skeleton());
  if (!roles.ok()) return named(roles.status());
  auto features = motion::DescribeMotion(clip, *roles);
  if (!features.ok()) return named(features.status());
  return features;
}

StatusOr<motion::MotionSets> ReadSets(const EvaluateOptions& options) {
  POISE_ASSIGN_OR_RETURN(const motion::ClipSet made, motion::ReadClipFolder(options.made, {}));
  POISE_ASSIGN_OR_RETURN(
      const motion::ClipSet data,
      motion::ReadClipFolder(options.data, {.action_class = options.action_class}));
  motion::MotionSets sets;
  for (const motion::LabelledClip& labelled : made.clips) {
    POISE_ASSIGN_OR_RETURN(sets.made.emplace_back(), Describe(labelled.clip));
  }
  for (const motion::LabelledClip& labelled : data.clips) {
    POISE_ASSIGN_OR_RETURN(const motion::MotionFeatures features, Describe(labelled.clip));
    const bool held_out = labelled.actor == options.hold_out;
    if (options.hold_out.empty() || held_out) sets.reference.push_back(features);
    if (options.hold_out.empty() || !held_out) sets.training.push_back(features);
  }
  return sets;
}

void PrintTable(const motion::SetComparison& c, const motion::MotionSets& sets,
                const Console& console) {
  Table table({"measure", "made", "training"});
  const auto row = [&](const std::string& name, double made, double training) {
    table.AddRow({name, fmt::format("{:.4f}", made), fmt::format("{:.4f}", training)});
  };
  row("MMD to the reference", c.mmd, c.mmd_training);
  table.AddRow({"  its p-value", fmt::format("{:.3f}", c.mmd_p), ""});
  row(fmt::format("min DTW, sets of {} [rad]", c.nearest_of), c.min_dtw, c.min_dtw_training);
  row("diversity [rad]", c.diversity, c.diversity_training);
  table.AddRow({"novelty, mean [rad]", fmt::format("{:.4f}", c.novelty), ""});
  table.AddRow({"novelty, least [rad]", fmt::format("{:.4f}", c.novelty_least), ""});
  row("mean joint speed [m/s]", c.mean_speed_mps, c.mean_speed_training_mps);
  row("foot skating [m/s]", c.foot_skate_mps, c.foot_skate_training_mps);
  table.AddRow({"oddly short or long [%]", fmt::format("{:.1f}", 100 * c.odd_lengths), ""});
  console.Print(table.Text());
  console.Print(fmt::format("{} made, {} training, {} reference motions", sets.made.size(),
                            sets.training.size(), sets.reference.size()));
}

Status RunSynthesis(const EvaluateOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const motion::MotionSets sets, ReadSets(options));
  base::RunContext context;
  context.seed = options.seed;
  POISE_ASSIGN_OR_RETURN(motion::SetComparison comparison,
                         motion::CompareSets(sets, options.compare, context));
  if (!console.json()) {
    PrintTable(comparison, sets, console);
    return absl::OkStatus();
  }
  base::Json json = base::FieldsToJson(comparison.Fields());
  json["made"] = sets.made.size();
  json["training"] = sets.training.size();
  json["reference"] = sets.reference.size();
  console.PrintJson(json);
  return absl::OkStatus();
}

}  // namespace

std::vector<Command> AddEvaluateCommands(CLI::App& app, const Console& console) {
  CLI::App* evaluate = app.add_subcommand("evaluate", kDescription);
  evaluate->footer("Example:\n  poise evaluate synthesis made/ --data ~/hdm05 --class kick");
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = evaluate->add_subcommand("synthesis", kSynthesisDescription);
  command->footer(kSynthesisFooter);
  command->add_option("MADE", options->made, "Folder of made motions")->type_name("")->required();
  command->add_option("--data", options->data, "Folder of the clips they were made from")
      ->type_name("DIR")
      ->required();
  command->add_option("--class", options->action_class, "Class of the clips: kick, jog, ...")
      ->type_name("CLASS");
  command->add_option("--hold-out", options->hold_out, "Actor the motions were not made from")
      ->type_name("ACTOR");
  command->add_option("--estimator", options->compare.mmd.estimator, "Of the MMD: unbiased, biased")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--permutations", options->compare.mmd.permutations, "For the p-value")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--nearest-of", options->compare.nearest_of,
                   "Motions among which the nearest is looked for; 0: as many as the smaller set")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of all random choices")
      ->type_name("N")
      ->capture_default_str();
  AddJsonFlag(*command);
  return {{command, [options, &console] { return RunSynthesis(*options, console); }},
          AddEvaluatePredictorCommand(*evaluate, console),
          AddEvaluatePushCommand(*evaluate, console)};
}

}  // namespace poise::cli
