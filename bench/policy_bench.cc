#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bench/benchmark.h"
#include "bench/policy_loop.h"
#include "bench/stream_kernel.h"
#include "core/learning/rl/fast_mlp.h"

/// How long a policy 200-1024-512-52 takes per sample on one thread, beside LibTorch on OpenBLAS as
/// it finds this CPU and as our programs set it, and beside the time to read the weights once.
namespace poise::bench {
namespace {

constexpr double kRequiredOfOne = 32;    // us
constexpr double kRequiredOfEight = 18;  // us per sample
constexpr int kCallsOfRound = 16;        // so that reading the clock costs nothing
const std::vector<int> kSizes = {kObservationSize, 1024, 512, kActionSize};

// Microseconds per sample.
double SampleTime(int batch, rl::Activation activation, base::Isa isa) {
  const rl::FastMlp mlp = *rl::FastMlp::Create(RandomLayers(kSizes), activation, isa);
  rl::FastMlp::Scratch scratch;
  const std::vector<float> input(batch * kObservationSize, 0.5f);
  std::vector<float> output(batch * kActionSize);
  const double rate = MeasureRate([&] {
    for (int i = 0; i < kCallsOfRound; ++i) mlp.Forward(input, batch, output, scratch);
  });
  return 1e6 / (rate * kCallsOfRound * batch);
}

// Microseconds to read the policy's weights, which the larger caches hold but the nearest do not.
double StreamTime() {
  constexpr long kUnit = 128;
  constexpr std::align_val_t kAlignment{64};
  long count = 0;
  for (size_t i = 0; i + 1 < kSizes.size(); ++i) count += kSizes[i] * kSizes[i + 1];
  count = count / kUnit * kUnit;
  const auto free = [](float* numbers) { operator delete(numbers, kAlignment); };
  const std::unique_ptr<float, decltype(free)> weights(
      static_cast<float*>(operator new(count * sizeof(float), kAlignment)), free);
  std::fill_n(weights.get(), count, 1.0f);
  const auto kernel =
      base::SelectKernel(isa_v2::StreamKernel, isa_v3::StreamKernel, isa_v4::StreamKernel);
  volatile float sink = 0;
  const double rate = MeasureRate([&] {
    for (int i = 0; i < kCallsOfRound; ++i) sink = kernel(weights.get(), count);
  });
  return 1e6 / (rate * kCallsOfRound);
}

// What LibTorch takes for one sample and per sample of eight, in a process of its own.
struct TorchTimes {
  std::string core;  // that OpenBLAS has kernels for
  double one = 0, eight = 0;
};

TorchTimes RunTorch(const std::string& environment) {
  const std::string program =
      std::filesystem::canonical("/proc/self/exe").parent_path() / "poise_torch_policy";
  const std::string command = fmt::format(
      "env -u OPENBLAS_CORETYPE OMP_WAIT_POLICY=PASSIVE OPENBLAS_NUM_THREADS=1 {} '{}' "
      "1 8",
      environment, program);
  FILE* pipe = popen(command.c_str(), "r");
  char line[256] = "";
  const bool read = pipe != nullptr && fgets(line, sizeof(line), pipe) != nullptr;
  if (!read || pclose(pipe) != 0) {
    fmt::print(stderr, "cannot run {}\n", command);
    std::abort();
  }
  TorchTimes times;
  std::istringstream(line) >> times.core >> times.one >> times.eight;
  return times;
}

// Names and environments: what OpenBLAS takes this CPU for (which differs between CPUs that it does
// not know), its AVX2 kernels, and those that our own programs ask for.
std::vector<std::pair<std::string, std::string>> TorchSettings() {
  std::vector<std::pair<std::string, std::string>> settings = {{"default", ""}};
  if (base::BestIsa() >= base::Isa::kV3) settings.push_back({"avx2", "OPENBLAS_CORETYPE=Haswell"});
  if (base::BestIsa() >= base::Isa::kV4) {
    settings.push_back({"avx512", "OPENBLAS_CORETYPE=SkylakeX"});
  }
  return settings;
}

}  // namespace

std::vector<Row> RunPolicyBenchmark() {
  const base::Isa best = base::BestIsa();
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, double time, const std::string& peer,
                       double peer_time, base::Isa isa) {
    rows.push_back(
        {"policy/" + name, time, "us/sample", peer, peer_time / time, 1, base::IsaName(isa)});
  };
  const double one = SampleTime(1, rl::Activation::kRelu, best);
  const double eight = SampleTime(8, rl::Activation::kRelu, best);
  const double stream = StreamTime();
  add("batch1", one, "32 us required", kRequiredOfOne, best);
  add("batch8", eight, "18 us required", kRequiredOfEight, best);
  add("batch1_vs_reading_weights", one, fmt::format("{:.1f} us to read the weights", stream),
      stream, best);
  for (const auto& [how, environment] : TorchSettings()) {
    const TorchTimes torch = RunTorch(environment);
    const std::string peer = "LibTorch, OpenBLAS " + torch.core;
    add("batch1_vs_libtorch_" + how, one, fmt::format("{}: {:.1f} us", peer, torch.one), torch.one,
        best);
    add("batch8_vs_libtorch_" + how, eight, fmt::format("{}: {:.1f} us", peer, torch.eight),
        torch.eight, best);
  }
  add("batch1_tanh", SampleTime(1, rl::Activation::kTanh, best), "relu", one, best);
  add("batch8_tanh", SampleTime(8, rl::Activation::kTanh, best), "relu", eight, best);
  for (const base::Isa isa : {base::Isa::kV2, base::Isa::kV3}) {
    if (isa >= best) continue;
    add("batch1_older_cpu", SampleTime(1, rl::Activation::kRelu, isa), "this CPU's", one, isa);
    add("batch8_older_cpu", SampleTime(8, rl::Activation::kRelu, isa), "this CPU's", eight, isa);
  }
  return rows;
}

}  // namespace poise::bench
