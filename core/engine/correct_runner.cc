#include "core/engine/correct_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "absl/time/clock.h"
#include "core/base/identifier.h"
#include "core/engine/clip_catalog.h"
#include "core/engine/correct_checkpoint.h"
#include "core/engine/job_files.h"
#include "core/pipeline/correct_run.h"
#include "core/pipeline/correct_settings.h"

namespace poise::engine {
namespace {

using pipeline::CorrectedVariant;
using pipeline::CorrectState;

StatusOr<api::CorrectSpec> SpecOf(const base::Json& parameters) {
  StatusOr<api::CorrectSpec> spec = api::CorrectSpec::FromJson(parameters);
  const Status status = spec.ok() ? pipeline::CheckCorrect(*spec) : spec.status();
  if (!status.ok()) return base::Annotate(status, "correct", "spec.parameters");
  return spec;
}

// None where the spec names none.
StatusOr<correction::DebiaserPtr> ReadDebiaser(const api::CorrectSpec& spec,
                                               const jobs::RunInput& input) {
  if (spec.debias_artifact.empty()) return correction::DebiaserPtr();
  POISE_ASSIGN_OR_RETURN(const artifacts::ModelArtifact model,
                         ReadModel(input, spec.debias_artifact, spec.debias, "debias_artifact"));
  return correction::Debiaser::Create(model);
}

StatusOr<CatalogClip> ReadSource(const api::ClipSource& source, const jobs::RunInput& input) {
  const auto& stored = std::get<api::StoredClip>(source.clip);
  POISE_ASSIGN_OR_RETURN(std::string data, ReadInput(input, stored.artifact, "artifact"));
  return DecodeSource({.name = stored.name,
                       .data = std::move(data),
                       .format = stored.format,
                       .skeleton_data = stored.skeleton_data,
                       .hints = stored.hints},
                      source.joint_roles);
}

// The sources as flows want them, how their files were written, and names for files.
struct Sources {
  std::vector<pipeline::ResolvedSource> clips;
  std::vector<motion::SourceConvention> conventions;
  std::vector<std::string> names;  // no two are the same
};

StatusOr<Sources> ReadSources(const api::CorrectSpec& spec, const jobs::RunInput& input) {
  Sources sources;
  std::set<std::string> taken;
  for (size_t i = 0; i < spec.sources.size(); ++i) {
    StatusOr<CatalogClip> clip = ReadSource(spec.sources[i], input);
    const std::string field = fmt::format("sources[{}]", i);
    if (!clip.ok()) return base::Annotate(clip.status(), field, field);
    sources.conventions.push_back(FileConvention(*clip));
    std::string name = clip->source.clip.name();
    std::replace(name.begin(), name.end(), '/', '_');
    sources.names.push_back(base::UniqueName(name, taken));
    sources.clips.push_back(std::move(clip->source));
  }
  return sources;
}

// Says whether a checkpoint is due, and keeps count of what they cost.
class CheckpointPace {
 public:
  explicit CheckpointPace(absl::Duration interval) : interval_(interval) {}

  bool Due() const {
    const absl::Time now = absl::Now();
    return now - last_ >= interval_ || cost_ <= kCheckpointShare * (now - begin_);
  }
  void Saved(absl::Time since) {
    last_ = absl::Now();
    cost_ += last_ - since;
  }

 private:
  const absl::Duration interval_;
  const absl::Time begin_ = absl::Now();
  absl::Time last_ = begin_;
  absl::Duration cost_ = absl::ZeroDuration();
};

StatusOr<jobs::RunOutput> Collect(const pipeline::CorrectFlow& flow,
                                  const pipeline::CorrectRun& run, const jobs::RunInput& input) {
  jobs::RunOutput output;
  for (const auto& variant : run.state().variants) {
    if (variant->report.file.empty()) continue;
    POISE_RETURN_IF_ERROR(
        WriteOutput(input, variant->report.file, "text/plain", variant->file_data, output));
  }
  output.report = {{"clips", base::Json::array()}};
  for (int source = 0; source < flow.num_sources(); ++source) {
    output.report["clips"].push_back(api::ToJson(run.Report(source)));
  }
  return output;
}

}  // namespace

StatusOr<pipeline::MotionDecoderPtr> CorrectRunner::Decoder(const api::CorrectSpec& spec,
                                                            const jobs::RunInput& input) const {
  if (spec.model_artifact.empty()) return pipeline::MotionDecoderPtr();
  if (!load_decoder_) {
    return base::FailedPrecondition("NO_NETWORKS", "model", "this program evaluates no networks");
  }
  POISE_ASSIGN_OR_RETURN(const artifacts::ModelArtifact model,
                         ReadModel(input, spec.model_artifact, spec.model, "model_artifact"));
  return load_decoder_(model);
}

StatusOr<jobs::RunOutput> CorrectRunner::Run(const jobs::RunInput& input,
                                             const jobs::JobContext& context) {
  POISE_ASSIGN_OR_RETURN(const api::CorrectSpec spec, SpecOf(input.spec.parameters));
  POISE_ASSIGN_OR_RETURN(Sources sources, ReadSources(spec, input));
  POISE_ASSIGN_OR_RETURN(pipeline::MotionDecoderPtr decoder, Decoder(spec, input));
  POISE_ASSIGN_OR_RETURN(correction::DebiaserPtr debiaser, ReadDebiaser(spec, input));
  POISE_ASSIGN_OR_RETURN(
      const auto flow,
      pipeline::CorrectFlow::Create(spec, input.seed, std::move(sources.clips),
                                    {make_learner_, std::move(decoder), std::move(debiaser)}));
  CorrectState state = CorrectState::Empty(*flow);
  if (input.checkpoint) {
    POISE_ASSIGN_OR_RETURN(state, DecodeCheckpoint(*input.checkpoint, std::move(state)));
  }
  CheckpointPace pace(context.checkpoint_interval);
  const int digits = std::max<int>(3, fmt::formatted_size("{}", spec.Variants() - 1));
  pipeline::CorrectRun run(
      *flow,
      {.max_seconds = spec.max_seconds,
       .finish =
           [&](CorrectedVariant& variant) {
             if (!variant.clip) return absl::OkStatus();
             variant.report.file =
                 fmt::format("{}_{}_{:0{}}.bvh", sources.names[variant.source_index], spec.method,
                             variant.report.index, digits);
             variant.file_data =
                 motion::EncodeBvh(*variant.clip, sources.conventions[variant.source_index]);
             variant.clip.reset();
             return absl::OkStatus();
           },
       .on_done = [&](const CorrectState& done, int64_t step) -> Status {
         if (!pace.Due()) return absl::OkStatus();
         const absl::Time begin = absl::Now();
         POISE_RETURN_IF_ERROR(context.save_checkpoint(EncodeCheckpoint(done), step));
         pace.Saved(begin);
         return absl::OkStatus();
       }},
      std::move(state));
  const Status status = run.Run(context.run);
  if (absl::IsCancelled(status)) {
    POISE_RETURN_IF_ERROR(context.save_checkpoint(EncodeCheckpoint(run.state()), run.step()));
  }
  POISE_RETURN_IF_ERROR(status);
  return Collect(*flow, run, input);
}

std::unique_ptr<jobs::JobRunner> MakeCorrectRunner() { return std::make_unique<CorrectRunner>(); }

Status ValidateCorrect(const base::Json& parameters) { return SpecOf(parameters).status(); }

bool CorrectNeedsTorch(const base::Json& parameters) {
  const StatusOr<api::CorrectSpec> spec = api::CorrectSpec::FromJson(parameters);
  return spec.ok() && (spec->effort == "full" || !spec->model_artifact.empty());
}

}  // namespace poise::engine
