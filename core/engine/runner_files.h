#ifndef POISE_CORE_ENGINE_RUNNER_FILES_H_
#define POISE_CORE_ENGINE_RUNNER_FILES_H_

#include <filesystem>
#include <string>

#include "core/base/status.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// The bytes of an artifact that the parameter `parameter` names.
/// Errors: kInvalidArgument MISSING_DATA with that field; kUnavailable CANNOT_READ.
StatusOr<std::string> ReadInput(const jobs::RunInput& input, const std::string& artifact,
                                const std::string& parameter);

/// Writes a file of the result and lists it. Errors: kResourceExhausted CANNOT_WRITE.
Status WriteOutput(const std::filesystem::path& folder, const std::string& name,
                   const std::string& media_type, const std::string& bytes,
                   jobs::RunOutput& output);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_RUNNER_FILES_H_
