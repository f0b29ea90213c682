#ifndef POISE_BENCH_OVERRIDES_H_
#define POISE_BENCH_OVERRIDES_H_

#include <string>
#include <vector>

#include "core/base/config_fields.h"

namespace poise::bench {

/// Of options "KEY=VALUE", as all programs here that learn take them; without "=" the value is "".
base::Overrides ToOverrides(const std::vector<std::string>& assignments);

}  // namespace poise::bench

#endif  // POISE_BENCH_OVERRIDES_H_
