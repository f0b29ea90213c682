#ifndef POISE_CORE_ARTIFACTS_ARTIFACT_NAME_H_
#define POISE_CORE_ARTIFACTS_ARTIFACT_NAME_H_

#include <string>
#include <string_view>

#include "core/base/status.h"

namespace poise::artifacts {

/// "artifacts/<64 hex digits>"
std::string ArtifactName(std::string_view sha256);

/// The digest of an artifact's name. Nothing else passes, so that a name can become a path.
/// Errors: kInvalidArgument BAD_ARTIFACT_NAME.
StatusOr<std::string> DigestOf(std::string_view artifact_name);

/// True for 64 lower-case hex digits.
bool IsSha256(std::string_view text);

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_ARTIFACT_NAME_H_
