#include "bench/overrides.h"

namespace poise::bench {

base::Overrides ToOverrides(const std::vector<std::string>& assignments) {
  base::Overrides overrides;
  for (const std::string& assignment : assignments) {
    const size_t equals = assignment.find('=');
    overrides[assignment.substr(0, equals)] =
        equals == std::string::npos ? "" : assignment.substr(equals + 1);
  }
  return overrides;
}

}  // namespace poise::bench
