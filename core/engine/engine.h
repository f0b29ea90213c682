#ifndef POISE_CORE_ENGINE_ENGINE_H_
#define POISE_CORE_ENGINE_ENGINE_H_

#include <filesystem>
#include <memory>

#include "core/api/augment_spec.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/status.h"
#include "core/base/telemetry.h"
#include "core/base/thread_pool.h"
#include "core/pipeline/augment.h"

namespace poise::engine {

struct EngineConfig {
  std::filesystem::path data_dir;  ///< artifacts live below it; made when absent
  int compute_threads = 0;         ///< <= 0: one per available CPU
};

/// Everything that outlives a request, built once per process: what the handlers call.
/// Threads: all members may be called from any thread.
class Engine {
 public:
  /// Errors: kFailedPrecondition BAD_DATA_DIR.
  static StatusOr<std::unique_ptr<Engine>> Create(const EngineConfig& config,
                                                  base::Telemetry& telemetry);

  /// Resolves the sources (decodes files, reads artifacts) and prepares their variants. The caller
  /// runs AugmentFlow::Make on compute().
  StatusOr<std::unique_ptr<pipeline::AugmentFlow>> PrepareAugment(const api::AugmentSpec& spec);

  artifacts::ArtifactStore& artifacts() { return *artifacts_; }
  base::ThreadPool& compute() { return *compute_; }

 private:
  Engine() = default;

  std::unique_ptr<artifacts::ArtifactStore> artifacts_;
  std::unique_ptr<base::ThreadPool> compute_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_ENGINE_H_
