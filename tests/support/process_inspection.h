#ifndef POISE_TESTS_SUPPORT_PROCESS_INSPECTION_H_
#define POISE_TESTS_SUPPORT_PROCESS_INSPECTION_H_

#include <sys/types.h>

#include <cstdint>
#include <vector>

/// What /proc tells about a process.
namespace poise::testing {

/// The processes whose parent is `pid`, those too that are dead and not yet waited for.
std::vector<pid_t> ChildrenOf(pid_t pid);
/// Those of them that live.
std::vector<pid_t> LivingChildrenOf(pid_t pid);
/// Resident memory, open descriptors and threads of a process; zeros when it is gone.
struct ProcessSize {
  int64_t resident_bytes = 0;
  int64_t descriptors = 0;
  int64_t threads = 0;
};
ProcessSize SizeOf(pid_t pid);
/// CPU time that a process has used; negative when it is gone.
double CpuSecondsOf(pid_t pid);

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_PROCESS_INSPECTION_H_
