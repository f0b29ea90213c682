#ifndef POISE_TESTS_SUPPORT_SANITIZER_H_
#define POISE_TESTS_SUPPORT_SANITIZER_H_

namespace poise::testing {

/// Whether this is a build of the presets asan or tsan, where memory and time tell nothing about
/// the product.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kInstrumented = true;
#else
inline constexpr bool kInstrumented = false;
#endif

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_SANITIZER_H_
