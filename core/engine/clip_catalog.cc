#include "core/engine/clip_catalog.h"

#include <utility>
#include <variant>

namespace poise::engine {
namespace {

StatusOr<CatalogClip> WithRoles(motion::Clip clip,
                                std::optional<motion::SourceConvention> convention,
                                const motion::RoleOverrides& overrides) {
  StatusOr<motion::JointRoles> roles = motion::JointRoles::Detect(*clip.skeleton(), overrides);
  if (!roles.ok()) {
    return base::Annotate(roles.status(), "clip '" + clip.name() + "'", "joint_roles");
  }
  return CatalogClip{{std::move(clip), *std::move(roles)}, std::move(convention)};
}

// `File` is EncodedClip or StoredClip; `field` is the field of its bytes.
template <typename File>
StatusOr<CatalogClip> Decode(const File& file, std::string_view data, std::string_view field,
                             const motion::RoleOverrides& overrides) {
  StatusOr<motion::ClipFile> clip =
      motion::DecodeClip(file.name, data, file.format, file.hints, file.skeleton_data);
  if (!clip.ok()) {
    // What a reader calls a field lies inside the file, and the caller sent the file.
    return base::MakeError(clip.status().code(), base::ErrorReason(clip.status()), field,
                           base::Message(clip.status()));
  }
  return WithRoles(std::move(clip->clip), std::move(clip->convention), overrides);
}

}  // namespace

StatusOr<CatalogClip> DecodeSource(const api::EncodedClip& file,
                                   const motion::RoleOverrides& joint_roles) {
  return Decode(file, file.data, "file.data", joint_roles);
}

motion::SourceConvention FileConvention(const CatalogClip& clip) {
  const bool was_bvh = clip.convention && clip.convention->format == motion::ClipFormat::kBvh;
  return was_bvh ? *clip.convention : motion::UsualBvhConvention();
}

StatusOr<CatalogClip> ClipCatalog::Resolve(api::ClipSource source) const {
  if (auto* clip = std::get_if<motion::Clip>(&source.clip)) {
    return WithRoles(std::move(*clip), std::nullopt, source.joint_roles);
  }
  if (const auto* file = std::get_if<api::EncodedClip>(&source.clip)) {
    return DecodeSource(*file, source.joint_roles);
  }
  const auto& stored = std::get<api::StoredClip>(source.clip);
  const StatusOr<std::string> data = artifacts_.ReadAll(stored.artifact, kMaxFileBytes);
  if (!data.ok()) {
    return base::MakeError(data.status().code(), base::ErrorReason(data.status()),
                           "stored.artifact", base::Message(data.status()));
  }
  artifacts_.Refresh(stored.artifact).IgnoreError();  // this call has what it needs
  return Decode(stored, *data, "stored.artifact", source.joint_roles);
}

}  // namespace poise::engine
