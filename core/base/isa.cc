#include "core/base/isa.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace poise::base {
namespace {

#ifdef __clang__
// Clang 14, with which the fuzz targets are built, knows features only, not levels.
bool SupportsV3() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
         __builtin_cpu_supports("fma");
}
bool SupportsV4() {
  return SupportsV3() && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd");
}
#else
bool SupportsV3() { return __builtin_cpu_supports("x86-64-v3"); }
bool SupportsV4() { return __builtin_cpu_supports("x86-64-v4"); }
#endif

Isa Detect() {
  const Isa best = SupportsV4() ? Isa::kV4 : SupportsV3() ? Isa::kV3 : Isa::kV2;
  const char* wish = std::getenv("POISE_ISA");
  const std::string_view name = wish == nullptr ? "" : wish;
  if (name == "v2") return Isa::kV2;
  if (name == "v3") return std::min(best, Isa::kV3);
  return best;
}

}  // namespace

Isa BestIsa() {
  static const Isa best = Detect();
  return best;
}

const char* IsaName(Isa isa) {
  switch (isa) {
    case Isa::kV4:
      return "x86-64-v4";
    case Isa::kV3:
      return "x86-64-v3";
    case Isa::kV2:
      break;
  }
  return "x86-64-v2";
}

}  // namespace poise::base
