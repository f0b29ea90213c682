#ifndef POISE_CORE_PUSH_TAKES_TAKE_FILE_H_
#define POISE_CORE_PUSH_TAKES_TAKE_FILE_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/push/takes/push_take.h"

/// Recorded takes in one tensor file (base/tensor_file.h), as workers get them: joints, rotations
/// (w last) and forces in double precision, everything else as JSON in the metadata ("takes").
/// Clips stay behind.
namespace poise::push {

std::string EncodeTakes(const std::vector<PushTake>& takes);

/// `what` names the bytes in messages. Errors: kInvalidArgument MALFORMED_TAKE; those of
/// DecodeTensors.
StatusOr<std::vector<PushTake>> DecodeTakes(std::string_view bytes, std::string_view what);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TAKES_TAKE_FILE_H_
