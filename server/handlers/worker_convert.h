#ifndef POISE_SERVER_HANDLERS_WORKER_CONVERT_H_
#define POISE_SERVER_HANDLERS_WORKER_CONVERT_H_

#include "core/runtime/jobs/job_store.h"
#include "poise/v1/worker_service.pb.h"

/// What workers say, between memory and the wire. What comes in is checked.
namespace poise::server {

/// Errors: kInvalidArgument BAD_JOB_NAME, with the field "fence.job".
StatusOr<jobs::Fence> FromProto(const v1::Fence& fence);
jobs::WorkerInfo FromProto(const v1::RegisterWorkerRequest& request);
/// Errors: kInvalidArgument BAD_WORKER, BAD_LEASE_TOKEN, TOO_MANY_NAMES.
StatusOr<jobs::ClaimQuery> FromProto(const v1::LeaseJobRequest& request);
api::JobUsage FromProto(const v1::Usage& usage);
/// Cut to what a job keeps of it.
base::Progress FromWorker(const v1::JobProgress& progress);
/// Without an error: succeeded. Errors: kInvalidArgument UNKNOWN_OUTCOME, BAD_OUTCOME (one that no
/// worker tells, or success with an error), TOO_MANY_ARTIFACTS, BAD_ARTIFACT_PATH (one that would
/// leave the folder into which a client puts the result).
StatusOr<jobs::Outcome> FromProto(const v1::FinishJobRequest& request);

v1::Lease ToProto(const jobs::Lease& lease);
v1::HeartbeatResponse ToProto(const jobs::HeartbeatReply& reply);

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_WORKER_CONVERT_H_
