#ifndef POISE_CORE_BASE_SHA256_H_
#define POISE_CORE_BASE_SHA256_H_

#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;

namespace poise::base {

/// SHA-256 of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();

  void Update(std::string_view bytes);
  /// 64 lower-case hex digits; nothing may be added afterwards.
  std::string HexDigest();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// Of bytes that are all there.
std::string Sha256Hex(std::string_view bytes);

}  // namespace poise::base

#endif  // POISE_CORE_BASE_SHA256_H_
