#include "core/engine/augment_run.h"

#include <utility>

namespace poise::engine {
namespace {

// Arrays on the wire: a quaternion per joint and a position per frame, in floats.
int64_t ArrayBytes(const motion::Clip& clip) {
  return int64_t{16} * clip.num_frames() * clip.num_joints() + int64_t{12} * clip.num_frames();
}

using Result = decltype(api::DeliveredVariant::result);

StatusOr<Result> AsFile(const api::Variant& variant, const motion::SourceConvention& convention,
                        artifacts::ArtifactStore& artifacts) {
  std::string bvh = motion::EncodeBvh(variant.clip, convention);
  if (static_cast<int64_t>(bvh.size()) > AugmentRun::kMaxInlineBytes) {
    POISE_ASSIGN_OR_RETURN(artifacts::ArtifactInfo stored, artifacts.Put(bvh));
    return Result(std::move(stored.name));
  }
  return Result(api::EncodedClip{.name = variant.clip.name() + ".bvh",
                                 .data = std::move(bvh),
                                 .format = motion::ClipFormat::kBvh,
                                 .skeleton_data = "",
                                 .hints = {}});
}

}  // namespace

StatusOr<api::DeliveredVariant> AugmentRun::Make(int64_t ordinal,
                                                 const base::RunContext& context) const {
  POISE_ASSIGN_OR_RETURN(api::Variant variant, flow_->Make(ordinal, context));
  const bool as_file =
      output_ == api::OutputEncoding::kBvh || ArrayBytes(variant.clip) > kMaxInlineBytes;
  StatusOr<Result> result = as_file
                                ? AsFile(variant, conventions_[variant.source_index], artifacts_)
                                : StatusOr<Result>(Result(std::move(variant.clip)));
  if (!result.ok()) return result.status();
  return api::DeliveredVariant{.source_index = variant.source_index,
                               .index = variant.index,
                               .seed = variant.seed,
                               .result = *std::move(result),
                               .ik = variant.ik,
                               .plausibility = variant.plausibility};
}

}  // namespace poise::engine
