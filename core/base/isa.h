#ifndef POISE_CORE_BASE_ISA_H_
#define POISE_CORE_BASE_ISA_H_

/// Instruction sets that hot kernels are built for (poise_kernel in cmake/PoiseTargets.cmake).
namespace poise::base {

enum class Isa { kV2, kV3, kV4 };  ///< x86-64-v2 (SSE4.2), -v3 (AVX2, FMA), -v4 (AVX-512)

/// The best one that this CPU has. POISE_ISA=v2|v3|v4 in the environment asks for a lesser one.
Isa BestIsa();

/// "x86-64-v3"
const char* IsaName(Isa isa);

/// Picks among three builds of one kernel: `static const auto fk = SelectKernel(isa_v2::Fk,
/// isa_v3::Fk, isa_v4::Fk);`
template <typename Function>
Function* SelectKernel(Function* v2, Function* v3, Function* v4) {
  switch (BestIsa()) {
    case Isa::kV4:
      return v4;
    case Isa::kV3:
      return v3;
    case Isa::kV2:
      break;
  }
  return v2;
}

}  // namespace poise::base

#endif  // POISE_CORE_BASE_ISA_H_
