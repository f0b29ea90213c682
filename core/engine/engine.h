#ifndef POISE_CORE_ENGINE_ENGINE_H_
#define POISE_CORE_ENGINE_ENGINE_H_

#include <filesystem>
#include <memory>

#include "core/api/augment_spec.h"
#include "core/api/push_spec.h"
#include "core/artifacts/artifact_store.h"
#include "core/artifacts/data_set_registry.h"
#include "core/artifacts/model_registry.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/base/telemetry.h"
#include "core/base/thread_pool.h"
#include "core/engine/augment_run.h"
#include "core/engine/decoder_cache.h"
#include "core/engine/forecaster.h"
#include "core/engine/job_manager.h"
#include "core/engine/model_catalog.h"
#include "core/pipeline/push.h"
#include "core/runtime/serving/push_catalog.h"

namespace poise::engine {

struct EngineConfig {
  /// Artifacts, jobs, models and data sets live below it; made when absent.
  std::filesystem::path data_dir;
  std::filesystem::path shipped_models = {};  ///< models that came with the program; may be absent
  DecoderLoader load_decoder = {};            ///< empty: no method "vae" (pipeline/load_decoder.h)
  int compute_threads = 0;                    ///< <= 0: one per available CPU
  /// [frames, > 0] Frames that one request may ask for: variants times the frames of their sources.
  int64_t max_output_frames = 2'000'000'000;
  serving::ServingConfig serving = serving::ServingConfig();
  JobManagerConfig jobs = JobManagerConfig();
};

/// Everything that outlives a request, built once per process: what the handlers call.
/// Threads: all members may be called from any thread.
class Engine {
 public:
  /// Errors: kFailedPrecondition BAD_DATA_DIR; those of OpenSqliteJobStore and
  /// JobManagerConfig::Validate.
  static StatusOr<std::unique_ptr<Engine>> Create(const EngineConfig& config,
                                                  base::Telemetry& telemetry);

  /// Resolves the sources (decodes files, reads artifacts) and prepares their variants. The caller
  /// runs AugmentRun::Make on compute(), while this engine lives.
  /// Errors: those of DecoderCache::Get; of ClipCatalog::Resolve and AugmentFlow::Create with the
  /// field "sources[i]"; kInvalidArgument REQUEST_TOO_LARGE; kCancelled, kDeadlineExceeded.
  StatusOr<std::unique_ptr<AugmentRun>> PrepareAugment(api::AugmentSpec spec,
                                                       const base::RunContext& context);

  Forecaster& forecaster() { return *forecaster_; }

  /// Resolves the people's clips and prepares the forecast. The caller runs PushFlow::Next on
  /// compute(). Errors: those of PushCatalog::Find, of ClipCatalog::Resolve and PushFlow::Create
  /// with the field "people[i].body"; kCancelled, kDeadlineExceeded.
  StatusOr<std::unique_ptr<pipeline::PushFlow>> PreparePush(api::PushSpec spec,
                                                            const base::RunContext& context);

  artifacts::ArtifactStore& artifacts() { return *artifacts_; }
  JobManager& jobs() { return *jobs_; }
  ModelCatalog& models() { return models_; }
  artifacts::DataSetRegistry& data_sets() { return *data_sets_; }
  base::ThreadPool& compute() { return *compute_; }

 private:
  // What is kept below the data folder.
  struct Stores {
    std::unique_ptr<jobs::JobStore> jobs;
    std::unique_ptr<artifacts::ArtifactStore> artifacts;
    std::unique_ptr<artifacts::ModelRegistry> models;
    std::unique_ptr<artifacts::DataSetRegistry> data_sets;
  };

  Engine(EngineConfig config, Stores stores, base::Telemetry& telemetry);

  JobManagerConfig JobsConfig();

  EngineConfig config_;
  std::unique_ptr<artifacts::ArtifactStore> artifacts_;
  std::unique_ptr<artifacts::ModelRegistry> model_registry_;
  ModelCatalog models_;
  serving::PushCatalog pushes_;
  DecoderCache decoders_;
  std::unique_ptr<artifacts::DataSetRegistry> data_sets_;
  std::unique_ptr<JobManager> jobs_;
  std::unique_ptr<Forecaster> forecaster_;
  base::Counter& sources_resolved_;
  std::unique_ptr<base::ThreadPool> compute_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_ENGINE_H_
