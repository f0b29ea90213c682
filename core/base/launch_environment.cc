// Gives LibTorch's BLAS and OpenMP their environment before any shared library starts.
//
// OpenBLAS reads OPENBLAS_CORETYPE, and OpenMP reads OMP_WAIT_POLICY, in the constructors of their
// libraries, which run before main: setenv in main is too late (measured: half the speed; with two
// threads and active waiting 3 to 28 times slower). A function in .preinit_array runs before every
// such constructor. It checks the CPU, and when a variable is missing or names kernels that this
// CPU cannot run, it executes the program again with the right ones. libc is not initialised yet,
// so this file uses system calls and its own buffers only.

#include <cpuid.h>
#include <sys/syscall.h>

namespace {

constexpr int kMaxVariables = 4096;
constexpr const char* kCoreType = "OPENBLAS_CORETYPE=";
constexpr const char* kWaitPolicy = "OMP_WAIT_POLICY=";

bool StartsWith(const char* text, const char* prefix) {
  while (*prefix != '\0') {
    if (*text++ != *prefix++) return false;
  }
  return true;
}

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// OpenBLAS compares names without regard to case.
bool Equals(const char* a, const char* b) {
  while (*a != '\0' && Lower(*a) == Lower(*b)) ++a, ++b;
  return Lower(*a) == Lower(*b);
}

struct CpuFeatures {
  bool avx2 = false;
  bool avx512 = false;
};

// Instruction sets that both the CPU and the operating system (XCR0) support.
CpuFeatures Detect() {
  CpuFeatures features;
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (!__get_cpuid(1, &a, &b, &c, &d) || (c & bit_OSXSAVE) == 0) return features;
  unsigned xcr0 = 0, high = 0;
  __asm__("xgetbv" : "=a"(xcr0), "=d"(high) : "c"(0));
  const bool saves_ymm = (xcr0 & 0x6) == 0x6;
  const bool saves_zmm = (xcr0 & 0xe6) == 0xe6;
  const bool fma = (c & bit_FMA) != 0;
  if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return features;
  features.avx2 = saves_ymm && fma && (b & bit_AVX2) != 0;
  constexpr unsigned kSkylakeX =
      bit_AVX512F | bit_AVX512CD | bit_AVX512BW | bit_AVX512DQ | bit_AVX512VL;
  features.avx512 = features.avx2 && saves_zmm && (b & kSkylakeX) == kSkylakeX;
  return features;
}

bool NeedsAvx512(const char* core) {
  return Equals(core, "SkylakeX") || Equals(core, "Cooperlake") || Equals(core, "SapphireRapids");
}

bool NeedsAvx2(const char* core) { return Equals(core, "Haswell") || Equals(core, "Zen"); }

// libc is not up: raw system call. Returns only when it failed, and then the program goes on.
void Execute(char** argv, char** envp) {
  const char* path = "/proc/self/exe";
  long result;
  __asm__ volatile("syscall"
                   : "=a"(result)
                   : "a"(SYS_execve), "D"(path), "S"(argv), "d"(envp)
                   : "rcx", "r11", "memory");
}

void PrepareEnvironment(int, char** argv, char** envp) {
  static char core_avx512[] = "OPENBLAS_CORETYPE=SkylakeX";
  static char core_avx2[] = "OPENBLAS_CORETYPE=Haswell";
  static char core_sse[] = "OPENBLAS_CORETYPE=Nehalem";
  static char wait_passive[] = "OMP_WAIT_POLICY=PASSIVE";
  static char* changed[kMaxVariables];

  const CpuFeatures cpu = Detect();
  char* best = cpu.avx512 ? core_avx512 : cpu.avx2 ? core_avx2 : core_sse;
  bool has_core = false, has_policy = false, replaced = false;
  int count = 0;
  for (; envp[count] != nullptr; ++count) {
    if (count + 3 >= kMaxVariables) return;
    char* variable = envp[count];
    if (StartsWith(variable, kCoreType)) {
      const char* core = variable + 18;
      has_core = true;
      // A wish that this CPU cannot run would end in an illegal instruction.
      if ((NeedsAvx512(core) && !cpu.avx512) || (NeedsAvx2(core) && !cpu.avx2)) {
        variable = best;
        replaced = true;
      }
    }
    if (StartsWith(variable, kWaitPolicy)) has_policy = true;
    changed[count] = variable;
  }
  if (has_core && has_policy && !replaced) return;
  if (!has_core) changed[count++] = best;
  if (!has_policy) changed[count++] = wait_passive;
  changed[count] = nullptr;
  Execute(argv, changed);
}

}  // namespace

extern "C" {
__attribute__((section(".preinit_array"),
               used)) void (*const poise_prepare_environment)(int, char**,
                                                              char**) = PrepareEnvironment;
}
