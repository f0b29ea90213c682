#ifndef POISE_CORE_ENGINE_CORRECT_CHECKPOINT_H_
#define POISE_CORE_ENGINE_CORRECT_CHECKPOINT_H_

#include <string>
#include <string_view>

#include "core/base/status.h"
#include "core/pipeline/correct_run.h"

namespace poise::engine {

/// What a correction has done, as the bytes of a job's checkpoint: reports and files to the last
/// bit, so that a job that goes on ends as one that was never interrupted. Clips are not in it.
std::string EncodeCheckpoint(const pipeline::CorrectState& state);

/// `empty` has the shape that the state must have.
/// Errors: kDataLoss CORRUPT_CHECKPOINT.
StatusOr<pipeline::CorrectState> DecodeCheckpoint(std::string_view bytes,
                                                  pipeline::CorrectState empty);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_CORRECT_CHECKPOINT_H_
