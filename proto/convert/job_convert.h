#ifndef POISE_PROTO_CONVERT_JOB_CONVERT_H_
#define POISE_PROTO_CONVERT_JOB_CONVERT_H_

#include <string>
#include <string_view>

#include "core/api/job.h"
#include "poise/v1/job.pb.h"
#include "poise/v1/job_service.pb.h"

/// Jobs between memory and the wire. What comes in is checked; the field named in errors is the
/// wire's.
namespace poise::convert {

/// "jobs/<id>" and back. Errors: kInvalidArgument BAD_JOB_NAME.
std::string JobName(std::string_view id);
StatusOr<std::string> JobId(std::string_view name);

v1::Job::State ToProto(api::JobState state);
/// Errors: kInvalidArgument UNKNOWN_JOB_STATE.
StatusOr<api::JobState> FromProto(v1::Job::State state);
v1::JobAttempt::Outcome ToProto(api::AttemptOutcome outcome);
StatusOr<api::AttemptOutcome> FromProto(v1::JobAttempt::Outcome outcome);

v1::JobSpec ToProto(const api::JobSpec& spec);
/// Whole numbers stay whole in JSON. Errors: kInvalidArgument NOT_FINITE.
StatusOr<api::JobSpec> FromProto(const v1::JobSpec& spec);

v1::JobError ToProto(const api::JobError& error);
api::JobError FromProto(const v1::JobError& error);
v1::JobLimits ToProto(const api::JobLimits& limits);
/// Zero and absent fields keep their defaults. Errors: those of JobLimits::Validate.
StatusOr<api::JobLimits> FromProto(const v1::JobLimits& limits);
v1::JobProgress ToProto(const base::Progress& progress);
base::Progress FromProto(const v1::JobProgress& progress);
v1::JobCheckpoint ToProto(const api::JobCheckpoint& checkpoint);
api::JobCheckpoint FromProto(const v1::JobCheckpoint& checkpoint);
v1::JobArtifact ToProto(const api::JobArtifact& artifact);
api::JobArtifact FromProto(const v1::JobArtifact& artifact);
v1::JobEvent ToProto(const api::JobEvent& event);
StatusOr<api::JobEvent> FromProto(const v1::JobEvent& event);

v1::Job ToProto(const api::Job& job);
StatusOr<api::Job> FromProto(const v1::Job& job);

v1::CreateJobRequest ToProto(const api::CreateJob& request);
/// Errors: those of the parts, and of CreateJob::Validate.
StatusOr<api::CreateJob> FromProto(const v1::CreateJobRequest& request);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_JOB_CONVERT_H_
