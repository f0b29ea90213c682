#ifndef POISE_SAMPLES_AUTHOR_IDLE_H_
#define POISE_SAMPLES_AUTHOR_IDLE_H_

#include "samples/author/track.h"

namespace poise::samples {

/// The channel with the small slow drift that a standing person never stops (breath, balance), so
/// that a held pose does not look frozen. `amplitude` in the channel's unit; `phase` [rad] sets one
/// channel's drift apart from another's.
VectorChannel WithIdle(VectorChannel channel, double amplitude, double phase);

}  // namespace poise::samples

#endif  // POISE_SAMPLES_AUTHOR_IDLE_H_
