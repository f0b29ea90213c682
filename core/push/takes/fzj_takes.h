#ifndef POISE_CORE_PUSH_TAKES_FZJ_TAKES_H_
#define POISE_CORE_PUSH_TAKES_FZJ_TAKES_H_

#include <filesystem>
#include <vector>

#include "core/base/status.h"
#include "core/push/takes/push_take.h"

namespace poise::push {

/// Reads the takes of one person alone (`single`) or of several people from the folder of the data
/// set FZJ Push (its README describes the files), in the order of its tables.
/// Errors: kNotFound FILE_NOT_FOUND; kInvalidArgument MALFORMED_CSV, MALFORMED_TAKE (a person or
/// frame too many or too few, a body that has not the 22 joints), and those of ReadClipFile.
StatusOr<std::vector<PushTake>> ReadSingleTakes(const std::filesystem::path& folder);
StatusOr<std::vector<PushTake>> ReadMultiTakes(const std::filesystem::path& folder);
/// Both, in this order.
StatusOr<std::vector<PushTake>> ReadTakes(const std::filesystem::path& folder);

/// Takes of one split, without copies.
std::vector<const PushTake*> TakesOf(const std::vector<PushTake>& takes, Split split);

/// The training takes parted into those that train and those that choose among settings; test takes
/// appear in neither. Single: one take a subject and session. Several people: every sixth training
/// take of a group. `fold` counts which ones; the same again after some.
struct TrainingTakes {
  std::vector<const PushTake*> train;
  std::vector<const PushTake*> validation;
};
TrainingTakes SplitTraining(const std::vector<PushTake>& takes, int fold = 0);
/// The same among some training takes. A set of one take trains; where there are such sets, both
/// sessions of a subject are one set.
TrainingTakes SplitTakes(const std::vector<const PushTake*>& training, int fold);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TAKES_FZJ_TAKES_H_
