#ifndef POISE_CORE_ENGINE_JOB_DIAGNOSIS_H_
#define POISE_CORE_ENGINE_JOB_DIAGNOSIS_H_

#include <vector>

#include "core/artifacts/artifact_store.h"
#include "core/base/run_context.h"
#include "core/runtime/jobs/job_store.h"

namespace poise::engine {

/// Checks the store, and that every artifact that its jobs name is there and is what was stored,
/// which reads them all. Errors: those of the store; kCancelled, kDeadlineExceeded.
StatusOr<std::vector<jobs::Finding>> DiagnoseJobs(jobs::JobStore& store,
                                                  const artifacts::ArtifactStore& artifacts,
                                                  const base::RunContext& context);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_JOB_DIAGNOSIS_H_
