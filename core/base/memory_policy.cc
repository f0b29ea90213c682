#include "core/base/memory_policy.h"

#include <malloc.h>

namespace poise::base {
namespace {

// Above the size of long clips; what is larger goes back to the system at once.
constexpr int kMapThresholdBytes = 32 << 20;
// Free memory that the top of the heap may hold.
constexpr int kTrimThresholdBytes = 128 << 20;

}  // namespace

void KeepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, kMapThresholdBytes);
  mallopt(M_TRIM_THRESHOLD, kTrimThresholdBytes);
}

}  // namespace poise::base
