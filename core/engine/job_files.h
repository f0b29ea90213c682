#ifndef POISE_CORE_ENGINE_JOB_FILES_H_
#define POISE_CORE_ENGINE_JOB_FILES_H_

#include <string>
#include <string_view>

#include "core/artifacts/model_artifact.h"
#include "core/runtime/jobs/job_runner.h"

/// Files that runners of jobs read and write.
namespace poise::engine {

/// Checkpoints may take this part of a job's time; more than that, and they wait for the interval.
inline constexpr double kCheckpointShare = 0.05;

/// The bytes of an artifact that the job's parameters name; `field` is the parameter that does.
/// Errors: kNotFound INPUT_NOT_FOUND with the field.
StatusOr<std::string> ReadInput(const jobs::RunInput& input, const std::string& artifact,
                                std::string_view field);

/// The model in it, which the parameters call `name`.
/// Errors: those of ReadInput and artifacts::UnpackModel, with the field.
StatusOr<artifacts::ModelArtifact> ReadModel(const jobs::RunInput& input,
                                             const std::string& artifact, const std::string& name,
                                             std::string_view field);

/// Writes a file of the result and notes it in `output`. Errors: kResourceExhausted CANNOT_WRITE.
Status WriteOutput(const jobs::RunInput& input, const std::string& name,
                   const std::string& media_type, std::string_view bytes, jobs::RunOutput& output);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_JOB_FILES_H_
