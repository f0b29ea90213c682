#include "server/handlers/job_pages.h"

#include <algorithm>
#include <utility>

#include "proto/convert/job_convert.h"

namespace poise::server {
namespace {

// A message may have 64 MiB, and a single job never has half of this.
constexpr size_t kMaxPageBytes = 16 << 20;

}  // namespace

StatusOr<v1::ListJobsResponse> ListPage(engine::JobManager& jobs, jobs::ListQuery query) {
  for (;;) {
    POISE_ASSIGN_OR_RETURN(api::JobPage page, jobs.List(query));
    v1::ListJobsResponse response;
    size_t bytes = 0;
    for (const api::Job& job : page.jobs) {
      *response.add_jobs() = convert::ToProto(job);
      bytes += response.jobs().rbegin()->ByteSizeLong();
      if (bytes > kMaxPageBytes) break;
    }
    if (bytes <= kMaxPageBytes || page.jobs.size() == 1) {
      response.set_next_page_token(std::move(page.next_page_token));
      return response;
    }
    query.page_size = std::max(response.jobs_size() / 2, 1);
  }
}

}  // namespace poise::server
