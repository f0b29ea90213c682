#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <set>

#include "client/cli/augment_report.h"
#include "client/cli/clip_input.h"
#include "client/cli/commands.h"
#include "client/cli/file_access.h"
#include "client/cli/interrupt.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/progress_bar.h"
#include "client/client.h"
#include "core/base/identifier.h"
#include "core/motion/metrics/plausibility.h"

namespace poise::cli {
namespace {

namespace fs = std::filesystem;

constexpr char kDescription[] =
    "Make variants of motion clips on a Poise server.\n\n"
    "They are written as BVH files, in the unit, axes and channels of a source that is BVH itself. "
    "A method is a chain of steps joined by '+': ik moves the hand or foot that acts to new "
    "targets "
    "around where it went, timewarp changes the speed, noise shakes the joints, mirror swaps the "
    "sides, vae makes new motions of the class that a model learned. The same seed gives the same "
    "files. The table at the end compares how plausible the "
    "variants look with their source.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise augment kick.bvh -n 20 --seed 1 --out kicks\n"
    "  poise augment punch.amc --method ik --class punch --preset paper --out punches\n"
    "  poise augment *.bvh --method mirror+noise -n 5 --json > variants.jsonl\n"
    "  poise augment kick.bvh --set ik.radius_high=1.1\n"
    "  poise augment kick.bvh --method vae+timewarp --model kick -n 100 --out kicks\n\n"
    "A key that --set does not know is answered with the nearest one.\n"
    "No server yet?  poised --listen 127.0.0.1:50051 --data-dir ~/.poise";

struct AugmentOptions {
  std::vector<std::string> files;
  api::AugmentSpec spec;
  std::vector<std::string> assignments;  // of --set
  std::string out = "augmented";
  double timeout_s = 0;
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  ReaderFlags reader;
};

/// A source file and what the variants' files need of it.
struct Source {
  std::string file;
  std::string name;  // begins the variants' file names; no two are the same
  motion::SourceConvention convention;
};

/// Everything that one run hands from step to step.
struct Work {
  api::AugmentSpec spec;
  std::vector<Source> sources;
  std::vector<AugmentReport::Source> report_sources;
};

StatusOr<Work> ReadSources(const AugmentOptions& options) {
  Work work{.spec = options.spec, .sources = {}, .report_sources = {}};
  POISE_ASSIGN_OR_RETURN(work.spec.overrides, ParsePairs(options.assignments, "set"));
  std::set<std::string> names;
  for (const std::string& file : options.files) {
    POISE_ASSIGN_OR_RETURN(LoadedClip loaded, LoadClip(file, options.reader));
    const std::string name = base::UniqueName(fs::path(file).stem().string(), names);
    auto plausibility = motion::AssessPlausibility(loaded.file.clip, loaded.roles);
    work.report_sources.push_back(
        {name, plausibility.ok() ? std::optional(*plausibility) : std::nullopt});
    work.sources.push_back(
        {.file = file, .name = name, .convention = std::move(loaded.file.convention)});
    work.spec.sources.push_back(
        {.clip = std::move(loaded.file.clip), .joint_roles = std::move(loaded.role_overrides)});
  }
  POISE_RETURN_IF_ERROR(work.spec.Validate());
  return work;
}

// The variant as BVH text in the convention of its source.
StatusOr<std::string> BvhText(const api::DeliveredVariant& variant, const Source& source,
                              client::Client& client) {
  if (const auto* clip = std::get_if<motion::Clip>(&variant.result)) {
    return motion::EncodeBvh(*clip, source.convention);
  }
  if (const auto* file = std::get_if<api::EncodedClip>(&variant.result)) return file->data;
  // Too large for a message: a file in the server's own convention.
  motion::ClipHints hints;
  hints.up = motion::UpAxis::kY;
  POISE_ASSIGN_OR_RETURN(const std::string stored,
                         client.Download(std::get<std::string>(variant.result)));
  POISE_ASSIGN_OR_RETURN(
      const motion::ClipFile decoded,
      motion::DecodeClip(source.name + ".bvh", stored, motion::ClipFormat::kBvh, hints));
  return motion::EncodeBvh(decoded.clip, source.convention);
}

fs::path VariantPath(const AugmentOptions& options, const Source& source, int index) {
  const int digits = fmt::formatted_size("{}", options.spec.variants_per_source - 1);
  return fs::path(options.out) / fmt::format("{}_{}_{:0{}}.bvh", source.name, options.spec.method,
                                             index, std::max(3, digits));
}

ProgressBar::Style ProgressStyle(const Console& console) {
  if (console.json()) return ProgressBar::Style::kNone;
  return Console::HasTerminal() ? ProgressBar::Style::kBar : ProgressBar::Style::kLines;
}

// Writes each variant as it comes.
Status ReceiveVariants(const AugmentOptions& options, const Work& work, client::Client& client,
                       client::VariantStream& stream, AugmentReport& report,
                       const Console& console) {
  const int64_t total = static_cast<int64_t>(work.sources.size()) * work.spec.variants_per_source;
  ProgressBar progress(ProgressStyle(console), total, "variants");
  for (int64_t done = 1;; ++done) {
    POISE_ASSIGN_OR_RETURN(const auto variant, stream.Next());
    if (!variant) return absl::OkStatus();
    if (variant->source_index < 0 ||
        variant->source_index >= static_cast<int>(work.sources.size())) {
      return base::Internal("BAD_ANSWER", fmt::format("the server answered for source {} of {}",
                                                      variant->source_index, work.sources.size()));
    }
    const Source& source = work.sources[variant->source_index];
    const fs::path path = VariantPath(options, source, variant->index);
    POISE_ASSIGN_OR_RETURN(const std::string text, BvhText(*variant, source, client));
    POISE_RETURN_IF_ERROR(WriteFile(path, text));
    report.Add(*variant);
    if (console.json()) {
      console.PrintJson(VariantJson(*variant, source.file, path.string(), work.spec.method));
    }
    progress.Update(done);
  }
}

Status RunAugment(AugmentOptions& options, const Console& console) {
  if (options.timeout_s > 0) options.connection.timeout = absl::Seconds(options.timeout_s);
  POISE_ASSIGN_OR_RETURN(const Work work, ReadSources(options));
  std::mutex mutex;
  std::unique_ptr<client::VariantStream> stream;
  InterruptHandler interrupt([&] {
    const std::lock_guard lock(mutex);
    if (stream != nullptr) stream->Cancel();
  });
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_RETURN_IF_ERROR(MakeFolder(options.out));
  POISE_ASSIGN_OR_RETURN(auto started, client->Augment(work.spec));
  {
    const std::lock_guard lock(mutex);
    stream = std::move(started);
    if (interrupt.interrupted()) stream->Cancel();
  }
  AugmentReport report(work.report_sources);
  const Status status = ReceiveVariants(options, work, *client, *stream, report, console);
  {
    const std::lock_guard lock(mutex);
    stream.reset();
  }
  POISE_RETURN_IF_ERROR(status);
  if (!console.json()) {
    console.Print(report.Text());
    console.Print(fmt::format("BVH files: {}", fs::path(options.out).string()));
  }
  return absl::OkStatus();
}

void AddSpecFlags(CLI::App& command, AugmentOptions& options) {
  command.add_option("--method", options.spec.method, "Steps: ik, timewarp, noise, mirror")
      ->type_name("STEPS")
      ->capture_default_str();
  command
      .add_option("--class", options.spec.action_class,
                  "What the clip shows, which sets where IK targets lie: kick, punch, walk, jog, "
                  "sneak, grab, deposit or throw")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--model", options.spec.model, "The network of step vae (poise models list)")
      ->type_name("NAME");
  command.add_option("--preset", options.spec.preset, "recommended or paper (as MotionAug did)")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("-n,--variants", options.spec.variants_per_source, "Variants of each file")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", options.spec.seed, "Seed of all random choices")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--set", options.assignments, "A hyper-parameter; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

}  // namespace

Command AddAugmentCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<AugmentOptions>();
  CLI::App* command = app.add_subcommand("augment", kDescription);
  command->footer(kFooter);
  command->add_option("FILE", options->files, "Motion files")->type_name("")->required();
  AddSpecFlags(*command, *options);
  command->add_option("--out", options->out, "Folder for the BVH files, made when absent")
      ->type_name("FOLDER")
      ->capture_default_str();
  AddServerFlag(*command, options->connection.server);
  AddTimeoutFlag(*command, options->timeout_s);
  AddReaderFlags(*command, options->reader);
  AddJsonFlag(*command);
  return {command, [options, &console] { return RunAugment(*options, console); }};
}

}  // namespace poise::cli
