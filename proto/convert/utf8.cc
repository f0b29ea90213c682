#include "proto/convert/utf8.h"

#include <cstdint>

namespace poise::convert {
namespace {

struct Form {
  int length;        // bytes
  uint32_t minimum;  // smaller code points have a shorter form
};

Form FormOf(unsigned char lead) {
  if (lead < 0x80) return {1, 0};
  if ((lead & 0xe0) == 0xc0) return {2, 0x80};
  if ((lead & 0xf0) == 0xe0) return {3, 0x800};
  if ((lead & 0xf8) == 0xf0) return {4, 0x10000};
  return {0, 0};
}

// Bytes of the valid character at the start of `text`, or 0.
int CharacterLength(std::string_view text) {
  const Form form = FormOf(static_cast<unsigned char>(text[0]));
  if (form.length <= 1) return form.length;
  if (text.size() < static_cast<size_t>(form.length)) return 0;
  uint32_t code = static_cast<unsigned char>(text[0]) & (0x7f >> form.length);
  for (int i = 1; i < form.length; ++i) {
    const unsigned char byte = text[i];
    if ((byte & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte & 0x3f);
  }
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return code < form.minimum || code > 0x10ffff || surrogate ? 0 : form.length;
}

}  // namespace

std::string ValidUtf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const int length = CharacterLength(text);
    if (length == 0) {
      valid += '?';
      text.remove_prefix(1);
    } else {
      valid += text.substr(0, length);
      text.remove_prefix(length);
    }
  }
  return valid;
}

}  // namespace poise::convert
