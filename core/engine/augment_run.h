#ifndef POISE_CORE_ENGINE_AUGMENT_RUN_H_
#define POISE_CORE_ENGINE_AUGMENT_RUN_H_

#include <memory>
#include <vector>

#include "core/api/augment_spec.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/motion/io/clip_file.h"
#include "core/pipeline/augment.h"

namespace poise::engine {

/// An AugmentSpec under way: makes variants in the form in which the caller wants them.
/// Threads: Make may be called from several threads.
class AugmentRun {
 public:
  /// A variant above this size becomes an artifact: half of the 64 MiB that fit in a message.
  static constexpr int64_t kMaxInlineBytes = 32 << 20;

  /// `conventions` has one entry per source; where empty, files are written in the default one.
  AugmentRun(std::unique_ptr<pipeline::AugmentFlow> flow, api::OutputEncoding output,
             std::vector<motion::SourceConvention> conventions, artifacts::ArtifactStore& artifacts)
      : flow_(std::move(flow)),
        output_(output),
        conventions_(std::move(conventions)),
        artifacts_(artifacts) {}

  int64_t num_variants() const { return flow_->num_variants(); }

  /// Variant `ordinal`, 0 .. num_variants() - 1, in the order of sources. Errors: those of
  /// AugmentFlow::Make and ArtifactStore::Put.
  StatusOr<api::DeliveredVariant> Make(int64_t ordinal, const base::RunContext& context) const;

 private:
  std::unique_ptr<pipeline::AugmentFlow> flow_;
  api::OutputEncoding output_;
  std::vector<motion::SourceConvention> conventions_;
  artifacts::ArtifactStore& artifacts_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_AUGMENT_RUN_H_
