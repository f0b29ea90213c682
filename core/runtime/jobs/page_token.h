#ifndef POISE_CORE_RUNTIME_JOBS_PAGE_TOKEN_H_
#define POISE_CORE_RUNTIME_JOBS_PAGE_TOKEN_H_

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/status.h"
#include "core/runtime/jobs/job_store.h"

namespace poise::jobs {

/// Says where the next page of `query` begins: after the row with this number. It fits only the
/// same tenant and filter; the page size may change.
std::string MakePageToken(const ListQuery& query, int64_t after);

/// nullopt without a token. Errors: kInvalidArgument BAD_PAGE_TOKEN.
StatusOr<std::optional<int64_t>> ParsePageToken(const ListQuery& query);

/// The page size that a query means. Errors: kInvalidArgument BAD_PAGE_SIZE.
StatusOr<int> EffectivePageSize(const ListQuery& query);

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_PAGE_TOKEN_H_
