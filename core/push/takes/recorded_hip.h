#ifndef POISE_CORE_PUSH_TAKES_RECORDED_HIP_H_
#define POISE_CORE_PUSH_TAKES_RECORDED_HIP_H_

#include "core/push/takes/push_take.h"

namespace poise::push {

/// The path of a hip on the floor since frame 0 [m]: `frames`, of which those beyond the recording
/// repeat its last speed, slowed down. What networks that look ahead see at a recording's end.
std::vector<Eigen::Vector2d> RecordedHip(const TakePerson& person, int64_t frames);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TAKES_RECORDED_HIP_H_
