#include <fmt/format.h>

#include <fstream>
#include <string>

#include "CLI/CLI.hpp"
#include "bench/benchmark.h"
#include "core/base/json.h"
#include "core/base/memory_policy.h"

namespace poise::bench {
namespace {

base::Json ToJson(const Row& row) {
  return {{"name", row.name},   {"value", row.value},     {"unit", row.unit}, {"peer", row.peer},
          {"ratio", row.ratio}, {"threads", row.threads}, {"isa", row.isa}};
}

int Main(int argc, char** argv) {
  CLI::App app("Measures Poise against stated limits and other ways to do the same.",
               "poise_bench");
  std::string filter, json_path;
  app.add_option("--filter", filter, "run the benchmarks whose name contains this; default: all");
  app.add_option("--json", json_path, "also write the rows to this file, as a JSON array");
  CLI11_PARSE(app, argc, argv);

  base::Json rows = base::Json::array();
  int run = 0;
  for (const Benchmark& benchmark : Benchmarks()) {
    if (std::string(benchmark.name).find(filter) == std::string::npos) continue;
    ++run;
    for (const Row& row : benchmark.run()) {
      fmt::print("{:34} {:12.1f} {:12} {:8.2f} x {}\n", row.name, row.value, row.unit, row.ratio,
                 row.peer);
      rows.push_back(ToJson(row));
    }
  }
  if (run == 0) {
    fmt::print(stderr, "no benchmark is named like '{}'; benchmarks:", filter);
    for (const Benchmark& benchmark : Benchmarks()) fmt::print(stderr, " {}", benchmark.name);
    fmt::print(stderr, "\n");
    return 2;
  }
  if (json_path.empty()) return 0;
  std::ofstream out(json_path);
  out << rows.dump(2) << "\n";
  if (out.flush()) return 0;
  fmt::print(stderr, "cannot write '{}'\n", json_path);
  return 1;
}

}  // namespace
}  // namespace poise::bench

int main(int argc, char** argv) {
  poise::base::KeepFreedMemory();  // as poised does
  return poise::bench::Main(argc, argv);
}
