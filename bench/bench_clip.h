#ifndef POISE_BENCH_BENCH_CLIP_H_
#define POISE_BENCH_BENCH_CLIP_H_

#include "core/motion/clip.h"

namespace poise::bench {

/// A smooth motion of a body with HDM05's 31 joints and their names: what a captured clip weighs.
motion::Clip CapturedSizeClip(int frames, double frame_rate);

}  // namespace poise::bench

#endif  // POISE_BENCH_BENCH_CLIP_H_
