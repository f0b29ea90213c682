#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_FENCE_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_FENCE_H_

#include <string_view>

namespace poise::jobs::sqlite {

/// Which row of `leases` a worker's write must touch; ?1 is the job's id, ?2 the attempt, ?3 the
/// token's hash. No row: the lease is somebody else's, or nobody's.
/// Alone in its file, so that a test program can link another one in its place and show that the
/// tests notice.
std::string_view FenceCondition();

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_FENCE_H_
