#include "client/cli/benchmark_form_flags.h"

namespace poise::cli {

void AddBenchmarkFormFlags(CLI::App& command, motion::BenchmarkForm& form) {
  command
      .add_option("--rate", form.frame_rate, "Frames a second of the network; 0: the clips' own")
      ->type_name("HZ")
      ->capture_default_str();
  command
      .add_option("--body", form.body,
                  "roles (the 16 joints of the required roles) or all (every joint)")
      ->type_name("NAME")
      ->capture_default_str();
}

}  // namespace poise::cli
