#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <torch/torch.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/measure_rate.h"

/// Prints which kernels OpenBLAS runs on, and how long a policy 200-1024-512-52 takes in LibTorch
/// for each batch that is named: `poise_torch_policy 1 8` -> `Haswell 190.1 31.0`
/// (microseconds per sample, one thread).
int main(int argc, char** argv) {
  at::set_num_threads(1);
  const torch::InferenceMode inference;
  torch::nn::Sequential net(torch::nn::Linear(200, 1024), torch::nn::ReLU(),
                            torch::nn::Linear(1024, 512), torch::nn::ReLU(),
                            torch::nn::Linear(512, 52));
  // Which BLAS is behind LibTorch is the system's choice.
  const auto core =
      reinterpret_cast<const char* (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  std::printf("%s", core == nullptr ? "no-OpenBLAS" : core());
  for (int i = 1; i < argc; ++i) {
    const int batch = std::atoi(argv[i]);
    const torch::Tensor input = torch::randn({batch, 200});
    const double rate = poise::bench::MeasureRate([&] { net->forward(input); });
    std::printf(" %.2f", 1e6 / rate / batch);
  }
  std::printf("\n");
}
