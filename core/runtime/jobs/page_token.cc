#include "core/runtime/jobs/page_token.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/base/sha256.h"

namespace poise::jobs {
namespace {

constexpr int kDefaultPageSize = 50;
constexpr int kMaxPageSize = 1000;
constexpr size_t kDigestLength = 16;

std::string Digest(const ListQuery& query, int64_t after) {
  return base::Sha256Hex(fmt::format("{}\n{}\n{}", after, query.tenant, query.filter.ToString()))
      .substr(0, kDigestLength);
}

}  // namespace

std::string MakePageToken(const ListQuery& query, int64_t after) {
  return fmt::format("{:x}-{}", after, Digest(query, after));
}

StatusOr<std::optional<int64_t>> ParsePageToken(const ListQuery& query) {
  if (query.page_token.empty()) return std::optional<int64_t>();
  const std::string& token = query.page_token;
  int64_t after = 0;
  std::from_chars(token.data(), token.data() + token.size(), after, 16);
  if (token == MakePageToken(query, after)) return std::optional<int64_t>(after);
  return base::InvalidArgument("BAD_PAGE_TOKEN", "page_token",
                               "the token is not one of this server for this filter; begin again "
                               "without a token");
}

StatusOr<int> EffectivePageSize(const ListQuery& query) {
  if (query.page_size < 0) {
    return base::InvalidArgument(
        "BAD_PAGE_SIZE", "page_size",
        fmt::format("page_size is {}, expected 0 or more", query.page_size));
  }
  return query.page_size == 0 ? kDefaultPageSize : std::min(query.page_size, kMaxPageSize);
}

}  // namespace poise::jobs
