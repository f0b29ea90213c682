#ifndef POISE_BENCH_STREAM_KERNEL_H_
#define POISE_BENCH_STREAM_KERNEL_H_

/// Reads numbers as fast as this build's vectors can: what any evaluation of a network for one
/// sample has to do with its weights, whatever else it does.
/// `count` is a multiple of 128; `numbers` are aligned to 64 bytes. Returns their sum.
namespace poise::bench {

namespace isa_v2 {
float StreamKernel(const float* numbers, long count);
}
namespace isa_v3 {
float StreamKernel(const float* numbers, long count);
}
namespace isa_v4 {
float StreamKernel(const float* numbers, long count);
}

}  // namespace poise::bench

#endif  // POISE_BENCH_STREAM_KERNEL_H_
