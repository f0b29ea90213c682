#ifndef POISE_CORE_ENGINE_CLIP_CATALOG_H_
#define POISE_CORE_ENGINE_CLIP_CATALOG_H_

#include <optional>

#include "core/api/clip_source.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/status.h"
#include "core/motion/io/clip_file.h"
#include "core/pipeline/augment.h"

namespace poise::engine {

/// A source as a flow wants it, and how its file wrote it (absent for arrays).
struct CatalogClip {
  pipeline::ResolvedSource source;
  std::optional<motion::SourceConvention> convention;
};

/// A file whose bytes are here. Errors: those of DecodeClip and JointRoles::Detect, with the field
/// below the source ("file.data", "joint_roles").
StatusOr<CatalogClip> DecodeSource(const api::EncodedClip& file,
                                   const motion::RoleOverrides& joint_roles);

/// How a variant of the clip is written: as its file was when that was BVH, else as usual.
motion::SourceConvention FileConvention(const CatalogClip& clip);

/// Turns the clips that callers name, in whatever form, into clips in memory.
/// Threads: Resolve may be called from any thread.
class ClipCatalog {
 public:
  /// Files above this are read piece by piece elsewhere, never into memory.
  static constexpr int64_t kMaxFileBytes = 512'000'000;

  explicit ClipCatalog(artifacts::ArtifactStore& artifacts) : artifacts_(artifacts) {}

  /// Takes the source over: arrays are moved, not copied; a stored file that is used counts as
  /// stored anew, so that it is not collected. Errors: those of DecodeClip,
  /// ArtifactStore::ReadAll and JointRoles::Detect, with the field below the source ("file.data",
  /// "stored.artifact", "joint_roles").
  StatusOr<CatalogClip> Resolve(api::ClipSource source) const;

 private:
  artifacts::ArtifactStore& artifacts_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_CLIP_CATALOG_H_
