#include "core/engine/decoder_cache.h"

#include <utility>

namespace poise::engine {
namespace {

Status AtModel(const Status& status) {
  return base::MakeError(status.code(), base::ErrorReason(status), "model", base::Message(status));
}

}  // namespace

StatusOr<pipeline::MotionDecoderPtr> DecoderCache::Get(std::string_view model) {
  if (!loader_) {
    return base::FailedPrecondition("NO_NETWORKS", "model", "this program evaluates no networks");
  }
  const StatusOr<api::Model> found = models_.Get(model);
  if (!found.ok()) return AtModel(found.status());
  const std::string version = found->name + "@" + found->version;
  std::lock_guard lock(mutex_);
  for (auto entry = loaded_.begin(); entry != loaded_.end(); ++entry) {
    if (entry->version != version) continue;
    loaded_.splice(loaded_.begin(), loaded_, entry);
    return loaded_.front().decoder;
  }
  const StatusOr<artifacts::ModelArtifact> artifact = models_.Load(version);
  if (!artifact.ok()) return AtModel(artifact.status());
  StatusOr<pipeline::MotionDecoderPtr> decoder = loader_(*artifact);
  if (!decoder.ok()) return AtModel(decoder.status());
  loaded_.push_front({version, *decoder});
  if (loaded_.size() > kMaxLoaded) loaded_.pop_back();
  return decoder;
}

}  // namespace poise::engine
