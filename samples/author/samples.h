#ifndef POISE_SAMPLES_AUTHOR_SAMPLES_H_
#define POISE_SAMPLES_AUTHOR_SAMPLES_H_

#include <vector>

#include "samples/author/performance.h"

namespace poise::samples {

/// A right front kick from a fighting stance and back into it: shift, chamber, snap, recoil, land.
Performance Kick();

/// Two and a half gait cycles at a comfortable pace, straight ahead.
Performance Walk();

/// A step forward with a right straight punch from the hip, and back to guard.
Performance Punch();

/// The bundled samples; each is committed as samples/<name>.bvh.
std::vector<Performance> AllSamples();

}  // namespace poise::samples

#endif  // POISE_SAMPLES_AUTHOR_SAMPLES_H_
