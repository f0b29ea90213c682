#ifndef POISE_CORE_CORRECTION_PREPARATION_SPARSE_SAMPLES_H_
#define POISE_CORE_CORRECTION_PREPARATION_SPARSE_SAMPLES_H_

#include <optional>
#include <vector>

namespace poise::correction {

/// Values that are known in some frames only: between two known ones on a straight line, held
/// before the first and after the last, 0 where none is known.
inline std::vector<double> FillBetween(const std::vector<std::optional<double>>& known) {
  std::vector<double> filled(known.size(), 0.0);
  int before = -1;
  for (int f = 0; f < static_cast<int>(known.size()); ++f) {
    if (!known[f]) continue;
    for (int k = before + 1; k <= f; ++k) {
      filled[k] = before < 0
                      ? *known[f]
                      : *known[before] + (*known[f] - *known[before]) * (k - before) / (f - before);
    }
    before = f;
  }
  if (before < 0) return filled;
  for (size_t k = before + 1; k < known.size(); ++k) filled[k] = *known[before];
  return filled;
}

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_SPARSE_SAMPLES_H_
