#include "core/base/identifier.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/random.h>

#include <cstdlib>
#include <vector>

namespace poise::base {

std::string RandomHex(int bytes) {
  std::vector<unsigned char> random(bytes);
  // Up to 256 bytes come at once or not at all; a kernel without a random source cannot run us.
  if (getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    std::abort();
  }
  return fmt::format("{:02x}", fmt::join(random, ""));
}

std::string TimeOrderedId(absl::Time now) {
  return fmt::format("{:012x}{}", absl::ToUnixMillis(now), RandomHex(6));
}

std::string UniqueName(std::string_view wanted, std::set<std::string>& taken) {
  std::string name(wanted);
  for (int number = 2; !taken.insert(name).second; ++number) {
    name = fmt::format("{}-{}", wanted, number);
  }
  return name;
}

}  // namespace poise::base
