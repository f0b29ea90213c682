#ifndef POISE_CORE_PUSH_TAKES_ONSET_H_
#define POISE_CORE_PUSH_TAKES_ONSET_H_

#include <span>

#include "core/push/takes/push_take.h"

namespace poise::push {

/// The data set's rule for the frame in which a person starts to move: the first whose pelvis moves
/// along X at 0.1 m/s or more until the next; -1 when there is none. The pushed person starts in
/// frame 0.
int RecordedOnset(const TakePerson& person, bool pushed);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TAKES_ONSET_H_
