#include "core/base/isa.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace poise::base {
namespace {

Isa Detect() {
  Isa best = Isa::kV2;
  if (__builtin_cpu_supports("x86-64-v4")) {
    best = Isa::kV4;
  } else if (__builtin_cpu_supports("x86-64-v3")) {
    best = Isa::kV3;
  }
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
