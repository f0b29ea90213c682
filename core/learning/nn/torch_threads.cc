#include "core/learning/nn/torch_threads.h"

#include <ATen/Parallel.h>
#include <dlfcn.h>

namespace poise::learning {

void SetTorchThreads(int threads) {
  at::set_num_threads(threads);
  // Which BLAS is behind LibTorch is the system's choice, so its function may be absent.
  const auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set != nullptr) set(threads);
}

}  // namespace poise::learning
