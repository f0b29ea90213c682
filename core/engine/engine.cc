#include "core/engine/engine.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "core/engine/clip_catalog.h"
#include "core/runtime/jobs/sqlite_job_store.h"

namespace poise::engine {

StatusOr<std::unique_ptr<Engine>> Engine::Create(const EngineConfig& config,
                                                 base::Telemetry& telemetry) {
  POISE_RETURN_IF_ERROR(config.jobs.Validate());
  Stores stores;
  // First: who has the jobs has the folder, and a second process must not touch the artifacts.
  POISE_ASSIGN_OR_RETURN(stores.jobs, jobs::OpenSqliteJobStore({.path = config.data_dir / "jobs.db",
                                                                .policy = config.jobs.policy}));
  POISE_ASSIGN_OR_RETURN(stores.artifacts,
                         artifacts::ArtifactStore::Create({.root = config.data_dir / "artifacts"}));
  POISE_ASSIGN_OR_RETURN(
      stores.models, artifacts::ModelRegistry::Open(
                         {.root = config.data_dir / "models", .shipped = config.shipped_models}));
  POISE_ASSIGN_OR_RETURN(stores.data_sets, artifacts::DataSetRegistry::Open(
                                               config.data_dir / "data_sets", *stores.artifacts));
  return std::unique_ptr<Engine>(new Engine(config, std::move(stores), telemetry));
}

JobManagerConfig Engine::JobsConfig() {
  JobManagerConfig config = config_.jobs;
  config.data_dir = config_.data_dir;
  config.before_success = [this](const api::Job& job,
                                 const std::vector<api::JobArtifact>& artifacts) {
    return models_.ImportTrained(job, artifacts);
  };
  config.other_artifacts = [this] { return data_sets_->Artifacts(); };
  return config;
}

Engine::Engine(EngineConfig config, Stores stores, base::Telemetry& telemetry)
    : config_(std::move(config)),
      artifacts_(std::move(stores.artifacts)),
      model_registry_(std::move(stores.models)),
      models_(*model_registry_, *artifacts_),
      pushes_(*model_registry_),
      decoders_(models_, config_.load_decoder),
      data_sets_(std::move(stores.data_sets)),
      jobs_(std::make_unique<JobManager>(JobsConfig(), std::move(stores.jobs), *artifacts_,
                                         telemetry)),
      forecaster_(
          std::make_unique<Forecaster>(*artifacts_, *model_registry_, config_.serving, telemetry)),
      sources_resolved_(telemetry.counter("poise_augment_sources_total",
                                          "Source clips decoded for augmentation", {})),
      compute_(std::make_unique<base::ThreadPool>(config_.compute_threads)) {}

StatusOr<std::unique_ptr<AugmentRun>> Engine::PrepareAugment(api::AugmentSpec spec,
                                                             const base::RunContext& context) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  pipeline::MotionDecoderPtr decoder;
  if (!spec.model.empty()) {
    POISE_ASSIGN_OR_RETURN(decoder, decoders_.Get(spec.model));
  }
  const ClipCatalog catalog(*artifacts_);
  std::vector<pipeline::ResolvedSource> sources;
  std::vector<motion::SourceConvention> conventions;
  int64_t output_frames = 0;
  for (size_t i = 0; i < spec.sources.size(); ++i) {
    POISE_RETURN_IF_ERROR(context.Check());
    StatusOr<CatalogClip> clip = catalog.Resolve(std::move(spec.sources[i]));
    const std::string field = fmt::format("sources[{}]", i);
    if (!clip.ok()) return base::Annotate(clip.status(), field, field);
    output_frames += int64_t{clip->source.clip.num_frames()} * spec.variants_per_source;
    if (output_frames > config_.max_output_frames) {
      return base::InvalidArgument(
          "REQUEST_TOO_LARGE", "variants_per_source",
          fmt::format("{} variants of {} sources have more than {} frames together: ask for fewer "
                      "in one request",
                      spec.variants_per_source, spec.sources.size(), config_.max_output_frames));
    }
    conventions.push_back(FileConvention(*clip));
    sources.push_back(std::move(clip->source));
    sources_resolved_.Increment();
  }
  POISE_ASSIGN_OR_RETURN(
      std::unique_ptr<pipeline::AugmentFlow> flow,
      pipeline::AugmentFlow::Create(spec, std::move(sources), std::move(decoder)));
  return std::make_unique<AugmentRun>(std::move(flow), spec.output, std::move(conventions),
                                      *artifacts_);
}

StatusOr<std::unique_ptr<pipeline::PushFlow>> Engine::PreparePush(api::PushSpec spec,
                                                                  const base::RunContext& context) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  POISE_ASSIGN_OR_RETURN(const serving::ServedForecaster served,
                         pushes_.Find(spec.model, spec.overrides));
  const ClipCatalog catalog(*artifacts_);
  std::vector<std::optional<pipeline::ResolvedSource>> bodies(spec.people.size());
  for (size_t i = 0; i < spec.people.size(); ++i) {
    POISE_RETURN_IF_ERROR(context.Check());
    if (!spec.people[i].body) continue;
    StatusOr<CatalogClip> clip = catalog.Resolve(*std::move(spec.people[i].body));
    if (!clip.ok()) {
      return base::Annotate(clip.status(), fmt::format("people[{}]", i),
                            fmt::format("people[{}].body", i));
    }
    bodies[i] = std::move(clip->source);
  }
  return pipeline::PushFlow::Create(spec, std::move(bodies), served.model, *served.forecaster);
}

}  // namespace poise::engine
