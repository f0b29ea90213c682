#ifndef POISE_CLIENT_CLI_BENCHMARK_FORM_FLAGS_H_
#define POISE_CLIENT_CLI_BENCHMARK_FORM_FLAGS_H_

#include "client/cli/command_line.h"
#include "core/motion/dataset/benchmark_clips.h"

namespace poise::cli {

/// --rate and --body.
void AddBenchmarkFormFlags(CLI::App& command, motion::BenchmarkForm& form);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_BENCHMARK_FORM_FLAGS_H_
