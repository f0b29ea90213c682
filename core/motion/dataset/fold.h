#ifndef POISE_CORE_MOTION_DATASET_FOLD_H_
#define POISE_CORE_MOTION_DATASET_FOLD_H_

#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/motion/dataset/labelled_clip.h"

namespace poise::motion {

/// Who is learned from and who is not.
struct FoldChoice {
  std::string action_class = {};  ///< of IsOfClass; empty: all
  std::string held_out = {};      ///< actor; empty: nobody
};

/// Clips by their place in the set.
struct FoldClips {
  std::vector<size_t> train;
  std::vector<size_t> held_out;
  std::string description;  ///< "class kick, actors bd bk dg mm, tr held out"
};

/// Errors: kFailedPrecondition NO_CLIPS (of the class; or none is left to learn from; the message
/// lists actions or actors).
StatusOr<FoldClips> ChooseFold(const std::vector<LabelledClip>& clips, const FoldChoice& choice);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_FOLD_H_
