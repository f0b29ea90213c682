#ifndef POISE_CORE_MOTION_DATASET_LABELLED_CLIP_H_
#define POISE_CORE_MOTION_DATASET_LABELLED_CLIP_H_

#include <string>
#include <string_view>

#include "core/motion/clip.h"

namespace poise::motion {

/// What a sequence shows and who does it; empty where the data do not say.
struct ClipLabels {
  std::string action;
  std::string actor;
};

/// From the name of a file without its ending: HDM_<actor>_<action>_<take>..., as HDM05 and
/// MotionAug's set of it name their clips (MotionAug sec. 1.1). Empty labels for other names.
ClipLabels LabelsOf(std::string_view stem);

/// Whether an action is of a class: "kick" has kickLFront1Reps and kickRSide2Reps, not kickoff. The
/// class is the whole action, or is followed by a capital letter or a digit.
bool IsOfClass(std::string_view action, std::string_view action_class);

/// A sequence with what it shows.
struct LabelledClip {
  std::string action;
  std::string actor;
  Clip clip;
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_LABELLED_CLIP_H_
