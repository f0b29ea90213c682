#ifndef POISE_CORE_BASE_MEMORY_POLICY_H_
#define POISE_CORE_BASE_MEMORY_POLICY_H_

namespace poise::base {

/// Lets the heap of this process keep what was freed, for programs that make one clip after the
/// other: by default glibc maps every block of 128 KiB anew, and writing to its fresh pages costs
/// as much as making a message of that size. Call it first thing in main.
void KeepFreedMemory();

}  // namespace poise::base

#endif  // POISE_CORE_BASE_MEMORY_POLICY_H_
