#ifndef POISE_CORE_MOTION_SKELETON_JSON_H_
#define POISE_CORE_MOTION_SKELETON_JSON_H_

#include "core/base/json.h"
#include "core/base/status.h"
#include "core/motion/skeleton.h"

namespace poise::motion {

/// A list of {"name", "parent", "offset": [x, y, z], "end_site": [x, y, z] or absent}.
base::Json SkeletonToJson(const Skeleton& skeleton);
/// Errors: kInvalidArgument MALFORMED_SKELETON; those of Skeleton::Create.
StatusOr<SkeletonPtr> SkeletonFromJson(const base::Json& json);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_SKELETON_JSON_H_
