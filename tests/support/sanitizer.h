#ifndef POISE_TESTS_SUPPORT_SANITIZER_H_
#define POISE_TESTS_SUPPORT_SANITIZER_H_

#include <gtest/gtest.h>

namespace poise::testing {

/// Whether this is a build of the presets asan or tsan, where memory and time tell nothing about
/// the product.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kInstrumented = true;
#else
inline constexpr bool kInstrumented = false;
#endif

}  // namespace poise::testing

/// Stands in a test that finds a number by long computing: an instrumented build would take too
/// long for it, and other tests run the same code.
#define POISE_SKIP_WHERE_INSTRUMENTED() \
  if (::poise::testing::kInstrumented) GTEST_SKIP() << "too slow in an instrumented build"

#endif  // POISE_TESTS_SUPPORT_SANITIZER_H_
