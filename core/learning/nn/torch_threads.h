#ifndef POISE_CORE_LEARNING_NN_TORCH_THREADS_H_
#define POISE_CORE_LEARNING_NN_TORCH_THREADS_H_

namespace poise::learning {

/// Threads that LibTorch, and OpenBLAS behind it (which LibTorch's own setting does not reach), use
/// for one operation, in this process. With 1 a training run is the same bit for bit every time;
/// two runs on one thread each are faster than one on two.
void SetTorchThreads(int threads);

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_TORCH_THREADS_H_
