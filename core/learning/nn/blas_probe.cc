#include "core/learning/nn/blas_probe.h"

#include <ATen/ATen.h>
#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <time.h>

#include <algorithm>

namespace poise::learning {
namespace {

double ThreadCpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// OpenBLAS keeps threads of its own, which LibTorch's setting does not reach. Which BLAS is behind
// LibTorch is the system's choice, so its functions are looked up and may be absent.
class SingleThreadedBlas {
 public:
  SingleThreadedBlas() : set_(Find<void (*)(int)>("openblas_set_num_threads")) {
    const auto get = Find<int (*)()>("openblas_get_num_threads");
    if (set_ == nullptr || get == nullptr) return;
    threads_ = get();
    set_(1);
  }
  ~SingleThreadedBlas() {
    if (threads_ > 0) set_(threads_);
  }

 private:
  template <typename Function>
  static Function Find(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
  }

  void (*set_)(int);
  int threads_ = 0;
};

}  // namespace

double MeasureSgemmGflops() {
  constexpr int kSize = 512;
  constexpr double kOperations = 2.0 * kSize * kSize * kSize;
  constexpr double kBudgetSeconds = 0.1;
  constexpr int kRepeats = 20;

  at::set_num_threads(1);
  const SingleThreadedBlas single_threaded;
  const at::Tensor a = at::ones({kSize, kSize});
  at::Tensor product = at::empty({kSize, kSize});
  double best = 0;
  const double start = ThreadCpuSeconds();
  // The best of several: the first one warms up, and others may share the cache.
  for (int i = 0; i < kRepeats && ThreadCpuSeconds() - start < kBudgetSeconds; ++i) {
    const double begin = ThreadCpuSeconds();
    at::mm_out(product, a, a);
    best = std::max(best, kOperations / (ThreadCpuSeconds() - begin) / 1e9);
  }
  return best;
}

}  // namespace poise::learning
