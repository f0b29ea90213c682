// child_program --child: the child of ChildProcessRunner, for jobs of kind selftest; "litter",
// which leaves a process behind and writes to its errors; and "inputs", which reports its inputs.
// child_program --supervise FOLDER: runs a job that never ends in such a child.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "core/base/fail_point.h"
#include "core/runtime/jobs/child_process_runner.h"
#include "core/runtime/jobs/child_side.h"
#include "core/runtime/jobs/selftest_runner.h"

namespace poise::jobs {
namespace {

class LitterRunner : public JobRunner {
 public:
  StatusOr<RunOutput> Run(const RunInput& input, const JobContext&) override {
    if (fork() == 0) {
      while (true) pause();
    }
    std::string descriptors;
    for (int i = 0; i < 1024; ++i) {
      struct stat ignored {};
      if (fstat(i, &ignored) == 0) descriptors += fmt::format(" {}", i);
    }
    fmt::print(stderr, "descriptors:{}\nfolder: {}\n", descriptors, get_current_dir_name());
    fmt::print(stderr, "long: {}\n", std::string(10'000, 'x'));
    for (int i = 0; i < input.spec.parameters.value("lines", 0); ++i) {
      fmt::print(stderr, "line {}\n", i);
    }
    fmt::print(stderr, "no end of line");
    return RunOutput();
  }
};

/// Reports where its inputs are.
class InputsRunner : public JobRunner {
 public:
  StatusOr<RunOutput> Run(const RunInput& input, const JobContext&) override {
    RunOutput output;
    output.report = base::Json::object();
    for (const auto& [artifact, path] : input.inputs) output.report[artifact] = path.string();
    return output;
  }
};

StatusOr<std::unique_ptr<JobRunner>> MakeRunner(std::string_view kind) {
  if (kind == "inputs") return std::make_unique<InputsRunner>();
  if (kind == "litter") return std::make_unique<LitterRunner>();
  return MakeSelftestRunner();
}

int Supervise(const char* folder) {
  RunInput input;
  input.spec = {.kind = "selftest", .parameters = {{"steps", 1'000'000}, {"busy", true}}};
  input.folder = folder;
  JobContext context;
  context.run.progress = [](const base::Progress& progress) {
    fmt::print("step {}\n", progress.step);
    std::fflush(stdout);
  };
  context.save_checkpoint = [](std::string_view, int64_t) { return absl::OkStatus(); };
  ChildProcessConfig config;
  config.program = "/proc/self/exe";
  config.arguments = {"child_program", "--child"};
  ChildProcessRunner runner(config);
  return runner.Run(input, context).ok() ? 0 : 1;
}

}  // namespace
}  // namespace poise::jobs

int main(int argc, char** argv) {
  poise::base::SetFailPointsFromEnvironment();
  if (argc == 3 && std::string_view(argv[1]) == "--supervise")
    return poise::jobs::Supervise(argv[2]);
  return poise::jobs::ServeChild(poise::jobs::MakeRunner);
}
