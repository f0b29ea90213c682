#ifndef POISE_CORE_ENGINE_DECODER_CACHE_H_
#define POISE_CORE_ENGINE_DECODER_CACHE_H_

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/artifacts/model_artifact.h"
#include "core/base/status.h"
#include "core/engine/model_catalog.h"
#include "core/pipeline/augment.h"

namespace poise::engine {

/// Builds a network from its model; made by a target that links LibTorch (motion_decoders.h).
using DecoderLoader =
    std::function<StatusOr<pipeline::MotionDecoderPtr>(const artifacts::ModelArtifact& model)>;

/// Loaded networks by name@version, the latest used few; who uses one that goes keeps it.
/// Threads: all members may be called from any thread; one load at a time.
class DecoderCache {
 public:
  /// `models` outlives the cache. `loader` may be empty: then every load fails.
  DecoderCache(const ModelCatalog& models, DecoderLoader loader)
      : models_(models), loader_(std::move(loader)) {}

  /// Errors: those of ModelCatalog::Load and of the loader with the field "model";
  /// kFailedPrecondition NO_NETWORKS without a loader.
  StatusOr<pipeline::MotionDecoderPtr> Get(std::string_view model);

 private:
  static constexpr size_t kMaxLoaded = 8;

  struct Entry {
    std::string version;  // name@version, which never changes its meaning
    pipeline::MotionDecoderPtr decoder;
  };

  const ModelCatalog& models_;
  const DecoderLoader loader_;
  std::mutex mutex_;
  std::list<Entry> loaded_;  // the latest used first
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_DECODER_CACHE_H_
