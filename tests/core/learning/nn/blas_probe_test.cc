#include "core/learning/nn/blas_probe.h"

#include <gtest/gtest.h>
#include <stdio.h>

#include <sstream>
#include <string>

#include "core/base/isa.h"

namespace poise::learning {
namespace {

struct ProbeRun {
  std::string core_type;
  std::string wait_policy;
  double gflops = 0;
  int exit_code = -1;
};

// Runs the program with only these variables ("NAME=value ...").
ProbeRun RunWith(const std::string& environment) {
  const std::string command = "env -i " + environment + " " + POISE_BLAS_PROBE_PROGRAM;
  FILE* pipe = popen(command.c_str(), "r");
  char line[256] = "";
  ProbeRun run;
  if (fgets(line, sizeof(line), pipe) != nullptr) {
    std::istringstream(line) >> run.core_type >> run.wait_policy >> run.gflops;
  }
  run.exit_code = pclose(pipe);
  std::printf("env -i %-40s -> %s %s, %.0f GFLOP/s per core\n", environment.c_str(),
              run.core_type.c_str(), run.wait_policy.c_str(), run.gflops);
  return run;
}

// What the CPU of this machine can run best.
std::string BestCoreType() {
  switch (base::BestIsa()) {
    case base::Isa::kV4:
      return "SkylakeX";
    case base::Isa::kV3:
      return "Haswell";
    case base::Isa::kV2:
      break;
  }
  return "Nehalem";
}

TEST(BlasProbeTest, EmptyEnvironmentGetsTheBestKernelsAndPassiveWaiting) {
  const ProbeRun run = RunWith("");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.core_type, BestCoreType());
  EXPECT_EQ(run.wait_policy, "PASSIVE");
#ifdef __OPTIMIZE__
  EXPECT_GT(run.gflops, kFaultySgemmGflops);
#endif
}

TEST(BlasProbeTest, KernelsThatTheCpuCannotRunAreReplaced) {
  for (const std::string wish : {"SkylakeX", "skylakex", "Cooperlake", "SAPPHIRERAPIDS"}) {
    const ProbeRun run = RunWith("OPENBLAS_CORETYPE=" + wish);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.core_type, base::BestIsa() == base::Isa::kV4 ? wish : BestCoreType());
    EXPECT_GT(run.gflops, 0);
  }
}

TEST(BlasProbeTest, WishesThatTheCpuCanFulfilAreKept) {
  const ProbeRun run = RunWith("OPENBLAS_CORETYPE=Nehalem OMP_WAIT_POLICY=ACTIVE");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.core_type, "Nehalem");
  EXPECT_EQ(run.wait_policy, "ACTIVE");
}

}  // namespace
}  // namespace poise::learning
