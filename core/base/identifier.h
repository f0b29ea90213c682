#ifndef POISE_CORE_BASE_IDENTIFIER_H_
#define POISE_CORE_BASE_IDENTIFIER_H_

#include <set>
#include <string>
#include <string_view>

#include "absl/time/time.h"

namespace poise::base {

/// Hex digits from the system's random source: for what nobody may guess or have twice.
std::string RandomHex(int bytes);

/// 12 hex digits of milliseconds and 12 random ones; sorts by time, to the millisecond.
std::string TimeOrderedId(absl::Time now);

/// `wanted`, or "wanted-2", "wanted-3", ... where that is taken; the answer is taken from then on.
std::string UniqueName(std::string_view wanted, std::set<std::string>& taken);

}  // namespace poise::base

#endif  // POISE_CORE_BASE_IDENTIFIER_H_
