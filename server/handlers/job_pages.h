#ifndef POISE_SERVER_HANDLERS_JOB_PAGES_H_
#define POISE_SERVER_HANDLERS_JOB_PAGES_H_

#include "core/engine/job_manager.h"
#include "poise/v1/job_service.pb.h"

namespace poise::server {

/// A page of jobs that fits in a message: where jobs are large it is shorter than asked for, and
/// has a token. Errors: those of JobManager::List.
StatusOr<v1::ListJobsResponse> ListPage(engine::JobManager& jobs, jobs::ListQuery query);

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_JOB_PAGES_H_
