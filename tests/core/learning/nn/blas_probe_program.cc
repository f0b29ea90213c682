// Prints the environment that the libraries saw at their start, and the rate they reach.
#include <cstdio>
#include <cstdlib>

#include "core/learning/nn/blas_probe.h"

namespace {

const char* Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "unset" : value;
}

}  // namespace

int main() {
  std::printf("%s %s %.1f\n", Variable("OPENBLAS_CORETYPE"), Variable("OMP_WAIT_POLICY"),
              poise::learning::MeasureSgemmGflops());
}
