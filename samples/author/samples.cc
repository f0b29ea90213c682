#include "samples/author/samples.h"

namespace poise::samples {

std::vector<Performance> AllSamples() { return {Kick(), Walk(), Punch()}; }

}  // namespace poise::samples
