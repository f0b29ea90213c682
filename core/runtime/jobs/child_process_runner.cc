#include "core/runtime/jobs/child_process_runner.h"

#include <fmt/format.h>

#include <fstream>

#include "absl/time/clock.h"
#include "core/runtime/jobs/child_message.h"
#include "core/runtime/jobs/child_process.h"
#include "core/runtime/jobs/child_watch.h"

namespace poise::jobs {
namespace {

// Leaves the checkpoint where the child finds it.
StatusOr<ChildStart> Prepare(const RunInput& input, const JobContext& context) {
  ChildStart start;
  start.input = input;
  start.input.checkpoint.reset();
  start.checkpoint_interval = context.checkpoint_interval;
  if (context.run.deadline < absl::InfiniteFuture()) {
    start.deadline_in = context.run.deadline - absl::Now();
  }
  const std::filesystem::path folder = input.folder / kPrivateFolder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  bool written = !error;
  if (written && input.checkpoint) {
    start.checkpoint_file = folder / "resume";
    std::ofstream stream(start.checkpoint_file, std::ios::binary);
    stream << *input.checkpoint;
    stream.close();
    written = stream.good();
  }
  if (written) return start;
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_START", "",
                         fmt::format("cannot write to {}", folder.string()));
}

}  // namespace

StatusOr<RunOutput> ChildProcessRunner::Run(const RunInput& input, const JobContext& context) {
  usage_ = {};
  POISE_ASSIGN_OR_RETURN(const ChildStart start, Prepare(input, context));
  POISE_ASSIGN_OR_RETURN(std::unique_ptr<ChildProcess> process,
                         ChildProcess::Start({.program = config_.program,
                                              .arguments = config_.arguments,
                                              .environment = config_.environment,
                                              .folder = input.folder}));
  ChildWatch watch(config_, input, context, std::move(process));
  StatusOr<RunOutput> output = watch.Run(start);
  usage_ = watch.exit().usage;
  return output;
}

}  // namespace poise::jobs
