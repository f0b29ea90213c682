#include "tests/core/runtime/jobs/attempt_folder.h"

#include <fstream>
#include <iterator>

namespace poise::testing {

AttemptFolder::AttemptFolder(const base::Json& parameters, uint64_t seed) {
  input.job = "0123456789ab-cdef";
  input.attempt = 0;
  input.spec = {.kind = "selftest", .parameters = parameters};
  input.seed = seed;
  input.trace_id = "trace-1";
  context.run.seed = seed;
  context.run.progress = [this](const base::Progress& value) {
    progress.push_back(value);
    if (on_progress) on_progress(value);
  };
  context.save_checkpoint = [this](std::string_view bytes, int64_t step) {
    input.checkpoint = std::string(bytes);
    input.checkpoint_step = step;
    checkpoint_steps.push_back(step);
    return absl::OkStatus();
  };
}

StatusOr<jobs::RunOutput> AttemptFolder::Run(jobs::JobRunner& runner) {
  ++input.attempt;
  input.folder = folder_.path() / std::to_string(input.attempt);
  std::filesystem::create_directory(input.folder);
  return runner.Run(input, context);
}

std::map<std::string, std::string> AttemptFolder::Contents(const jobs::RunOutput& output) {
  std::map<std::string, std::string> contents;
  for (const jobs::OutputFile& file : output.files) {
    std::ifstream stream(file.path, std::ios::binary);
    contents[file.name] = std::string(std::istreambuf_iterator<char>(stream), {});
  }
  return contents;
}

}  // namespace poise::testing
