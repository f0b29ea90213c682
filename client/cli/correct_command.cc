#include <fmt/format.h>

#include <memory>
#include <set>

#include "absl/time/clock.h"
#include "client/cli/clip_input.h"
#include "client/cli/commands.h"
#include "client/cli/correct_report.h"
#include "client/cli/file_access.h"
#include "client/cli/jobs/job_follower.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_text.h"
#include "client/client.h"
#include "core/api/correct_spec.h"
#include "core/base/identifier.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {
namespace {

namespace fs = std::filesystem;

constexpr char kDescription[] =
    "Make variants of motion clips that a simulated body has imitated.\n\n"
    "Each file becomes a job on a Poise server. The variants of --method (or with none the clip "
    "itself) are imitated by a humanoid under gravity, with contacts and torque limits; what it "
    "did is written as BVH, in the form of the source. The table compares them before and after, "
    "and with the authors' controller without learning (zero policy): how plausible they look, and "
    "how well they were imitated (reward, from 0 to 1 over the whole clip) with how much outer "
    "force and torque. A variant that fell is written as it fell, and said so. The same seed gives "
    "the same files. Ctrl-C cancels the jobs.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise correct kick.bvh --method ik -n 20 --effort fast --out corrected\n"
    "  poise correct *.bvh --method none --effort instant --json > report.jsonl\n"
    "  poise correct kick.bvh -n 100 --max-seconds 60 --out corrected\n"
    "  poise correct kick.bvh --method vae --model kick -n 20\n"
    "  poise correct kick.bvh --debias kick-habits -n 20\n"
    "  poise correct kick.bvh --detach          # poise jobs watch, poise jobs result\n"
    "  poise correct kick.bvh --set learning.rollouts=40 --set ik.radius_high=1.1\n\n"
    "Exit code: 0 SUCCEEDED, 8 a job FAILED, 6 CANCELLED. A variant that was not completed is no "
    "failure of its job: see \"completed\".";

struct CorrectOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::vector<std::string> files;
  api::CorrectSpec spec;
  uint64_t seed = 0;
  std::vector<std::string> assignments;  // of --set
  std::string out = "corrected";
  std::string request_id;
  bool detach = false;
  ReaderFlags reader;
};

/// A file on its way to the server.
struct Source {
  std::string name;  // begins the variants' file names; no two are the same
  api::EncodedClip file;
  motion::RoleOverrides joint_roles;
};

// The file's own bytes where it is BVH, since variants are written in its form.
StatusOr<Source> ReadSource(const std::string& file, std::string name, const ReaderFlags& reader) {
  POISE_ASSIGN_OR_RETURN(LoadedClip loaded, LoadClip(file, reader));
  if (const Status status = loaded.roles.RequireComplete(); !status.ok()) {
    return base::Annotate(status, file);
  }
  const motion::SourceConvention read = loaded.file.convention;
  const bool is_bvh = read.format == motion::ClipFormat::kBvh;
  const motion::SourceConvention sent = is_bvh ? read : motion::UsualBvhConvention();
  Source source{.name = std::move(name), .file = {}, .joint_roles = loaded.role_overrides};
  if (is_bvh) {
    POISE_ASSIGN_OR_RETURN(source.file.data, ReadFile(file));
  } else {
    source.file.data = motion::EncodeBvh(loaded.file.clip, sent);
  }
  source.file.name = source.name + ".bvh";
  source.file.format = motion::ClipFormat::kBvh;
  source.file.hints = {
      .unit_m = sent.unit_m, .up = sent.up, .frame_rate = loaded.file.clip.frame_rate()};
  return source;
}

StatusOr<std::vector<Source>> ReadSources(const CorrectOptions& options) {
  std::vector<Source> sources;
  std::set<std::string> names;
  for (const std::string& file : options.files) {
    std::string name = base::UniqueName(fs::path(file).stem().string(), names);
    POISE_ASSIGN_OR_RETURN(sources.emplace_back(),
                           ReadSource(file, std::move(name), options.reader));
  }
  return sources;
}

StatusOr<api::Job> CreateJob(const CorrectOptions& options, const Source& source,
                             client::Client& client) {
  api::CorrectSpec spec = options.spec;
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored, client.Upload(source.file.data));
  spec.sources = {{.clip = api::StoredClip{.artifact = stored.name,
                                           .name = source.file.name,
                                           .format = source.file.format,
                                           .skeleton_data = "",
                                           .hints = source.file.hints},
                   .joint_roles = source.joint_roles}};
  POISE_RETURN_IF_ERROR(spec.Validate());
  std::string request_id = options.request_id;
  // One job a file: each needs an id of its own.
  if (!request_id.empty() && options.files.size() > 1) request_id += "-" + source.name;
  return client.CreateJob({.spec = {.kind = "correct", .parameters = spec.ToJson()},
                           .request_id = std::move(request_id),
                           .seed = options.seed});
}

// Pins a model: the job has the network that the name meant when it was submitted.
Status PinModel(client::Client& client, std::string& name, std::string& artifact) {
  if (name.empty()) return absl::OkStatus();
  POISE_ASSIGN_OR_RETURN(const api::Model model, client.GetModel(name));
  name = model.name + "@" + model.version;
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored, client.ExportModel(name));
  artifact = stored.name;
  return absl::OkStatus();
}

// The jobs as they are after a Ctrl-C: asked to stop, and given a moment to do so.
Status Cancel(client::Client& client, std::vector<CorrectedClip>& clips) {
  constexpr absl::Duration kPatience = absl::Seconds(15);
  for (const CorrectedClip& clip : clips) {
    POISE_RETURN_IF_ERROR(client.CancelJob(clip.job.id).status());
  }
  const absl::Time deadline = absl::Now() + kPatience;
  for (CorrectedClip& clip : clips) {
    POISE_ASSIGN_OR_RETURN(clip.job, client.Handle(clip.job.id).Wait(deadline));
  }
  return absl::OkStatus();
}

// Fetches what a job that SUCCEEDED left: the variants, and the manifest as NAME.json.
Status FetchResult(const CorrectOptions& options, client::Client& client, CorrectedClip& clip) {
  const fs::path folder = options.out;
  const client::JobHandle handle = client.Handle(clip.job.id);
  for (const api::JobArtifact& file : clip.job.artifacts) {
    if (file.name != "manifest.json") {
      POISE_RETURN_IF_ERROR(handle.SaveResult(folder, file.name).status());
      continue;
    }
    POISE_ASSIGN_OR_RETURN(const std::string text, client.Download(file.artifact));
    POISE_RETURN_IF_ERROR(WriteFile(folder / (clip.name + ".json"), text));
    POISE_ASSIGN_OR_RETURN(const base::Json manifest, base::ParseJson(text, file.name));
    const base::Json::json_pointer report("/report/clips/0");
    if (!manifest.contains(report)) return base::Internal("BAD_ANSWER", "the job has no report");
    POISE_ASSIGN_OR_RETURN(clip.report, api::CorrectedClipFromJson(manifest.at(report)));
  }
  return absl::OkStatus();
}

void Print(const CorrectOptions& options, const std::vector<CorrectedClip>& clips,
           const Console& console) {
  if (console.json()) {
    for (const CorrectedClip& clip : clips) {
      console.PrintJson(CorrectedClipJson(clip, options.out));
    }
    return;
  }
  if (options.detach) {
    for (const CorrectedClip& clip : clips) console.Print(convert::JobName(clip.job.id));
    return;
  }
  bool any = false;
  for (const CorrectedClip& clip : clips) {
    any |= clip.report.has_value();
    if (!clip.report) console.Print(fmt::format("{}: {}", clip.name, JobLine(clip.job)));
  }
  if (!any) return;
  console.Print(CorrectionText(clips));
  console.Print(fmt::format("BVH files: {}", options.out));
}

// Waits for the jobs, or cancels them when the user wants so; then fetches what there is.
Status Finish(const CorrectOptions& options, client::Client& client, JobFollower& follower,
              std::vector<CorrectedClip>& clips) {
  std::vector<std::string> ids;
  for (const CorrectedClip& clip : clips) ids.push_back(clip.job.id);
  const Status followed = follower.Follow(client, ids, absl::InfiniteFuture());
  if (absl::IsCancelled(followed)) return Cancel(client, clips);
  POISE_RETURN_IF_ERROR(followed);
  for (CorrectedClip& clip : clips) {
    POISE_ASSIGN_OR_RETURN(clip.job, client.GetJob(clip.job.id));
    if (clip.job.state != api::JobState::kSucceeded) continue;
    POISE_RETURN_IF_ERROR(FetchResult(options, client, clip));
  }
  return absl::OkStatus();
}

// A failure counts more than a wish.
Status Outcome(const std::vector<CorrectedClip>& clips) {
  Status outcome;
  for (const CorrectedClip& clip : clips) {
    const Status ended = JobOutcome(clip.job);
    if (outcome.ok() || clip.job.state == api::JobState::kFailed) outcome = ended;
  }
  return outcome;
}

Status RunCorrect(CorrectOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(options.spec.overrides, ParsePairs(options.assignments, "set"));
  POISE_ASSIGN_OR_RETURN(const std::vector<Source> sources, ReadSources(options));
  std::unique_ptr<JobFollower> follower;
  if (!options.detach) {
    follower = std::make_unique<JobFollower>(console, JobFollower::Style::kQuiet);
  }
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  if (follower) POISE_RETURN_IF_ERROR(MakeFolder(options.out));
  api::CorrectSpec& spec = options.spec;
  POISE_RETURN_IF_ERROR(PinModel(*client, spec.model, spec.model_artifact));
  POISE_RETURN_IF_ERROR(PinModel(*client, spec.debias, spec.debias_artifact));
  std::vector<CorrectedClip> clips;
  for (const Source& source : sources) {
    StatusOr<api::Job> job = CreateJob(options, source, *client);
    if (!job.ok()) {
      // The jobs before it are not what was asked for either.
      Cancel(*client, clips).IgnoreError();
      return base::Annotate(job.status(), source.name);
    }
    clips.push_back({.name = source.name, .job = *std::move(job), .report = std::nullopt});
    if (follower) console.Note(convert::JobName(clips.back().job.id) + "  " + source.name);
  }
  if (follower) POISE_RETURN_IF_ERROR(Finish(options, *client, *follower, clips));
  Print(options, clips, console);
  return follower ? Outcome(clips) : absl::OkStatus();
}

void AddSpecFlags(CLI::App& command, CorrectOptions& options) {
  api::CorrectSpec& spec = options.spec;
  command
      .add_option("--method", spec.method,
                  "none (the clip itself), or steps of augment joined by '+': ik, timewarp, noise, "
                  "mirror, vae")
      ->type_name("STEPS")
      ->capture_default_str();
  command
      .add_option("--class", spec.action_class,
                  "What the clip shows, which sets where IK targets lie, as in augment")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--model", spec.model, "The network of step vae: NAME or NAME@VERSION")
      ->type_name("MODEL");
  command
      .add_option("--debias", spec.debias,
                  "A network of poise train debias, which undoes what imitation changes: NAME or "
                  "NAME@VERSION")
      ->type_name("MODEL");
  command
      .add_option("-n,--variants", spec.variants_per_source,
                  "Variants of each file (default: 20; with --method none 1)")
      ->type_name("N");
  command
      .add_option("--effort", spec.effort,
                  "instant (no learning, under a second), fast (a few rollouts) or full (learns a "
                  "policy, minutes)")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--preset", spec.preset, "recommended or paper (as MotionAug did)")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--residual", spec.residual,
                  "What holds the body beside its muscles: none, rfc (learned), pd or pd_rfc")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Seed of all random choices")
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--max-seconds", spec.max_seconds,
                  "Of work for each file; then the best so far is the result (default: no limit)")
      ->type_name("SECONDS");
  command.add_option("--body-mass", spec.body_mass_kg, "Of the body (default: the preset's 45)")
      ->type_name("KG");
  command.add_option("--set", options.assignments, "A hyper-parameter; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

}  // namespace

Command AddCorrectCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<CorrectOptions>();
  CLI::App* command = app.add_subcommand("correct", kDescription);
  command->footer(kFooter);
  command->add_option("FILE", options->files, "Motion files")->type_name("")->required();
  AddSpecFlags(*command, *options);
  command->add_option("--out", options->out, "Folder for the BVH files, made when absent")
      ->type_name("FOLDER")
      ->capture_default_str();
  command->add_flag("--detach", options->detach, "Print the jobs' names and do not wait");
  command
      ->add_option("--request-id", options->request_id,
                   "The same id again is the same job (of several files: ID-NAME)")
      ->type_name("ID");
  AddReaderFlags(*command, options->reader);
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunCorrect(*options, console); }};
}

}  // namespace poise::cli
