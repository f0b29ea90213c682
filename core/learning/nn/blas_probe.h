#ifndef POISE_CORE_LEARNING_NN_BLAS_PROBE_H_
#define POISE_CORE_LEARNING_NN_BLAS_PROBE_H_

namespace poise::learning {

/// Below this a matrix product runs on the wrong BLAS: reference BLAS gives 8 GFLOP/s where
/// OpenBLAS gives 130 to 240.
inline constexpr double kFaultySgemmGflops = 50;

/// Rate at which LibTorch multiplies float matrices on one thread [GFLOP/s], so that a server that
/// loaded the wrong BLAS, or the wrong kernels, says so when it starts. Takes less than 0.2 s of
/// CPU; counts the thread's CPU time, so that a busy machine does not look like a slow library.
/// Sets the thread count of LibTorch to 1 for this process.
double MeasureSgemmGflops();

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_BLAS_PROBE_H_
