#ifndef POISE_PROTO_CONVERT_UTF8_H_
#define POISE_PROTO_CONVERT_UTF8_H_

#include <string>
#include <string_view>

namespace poise::convert {

/// `text` with every byte that is not part of valid UTF-8 replaced by '?'. Joint names come from
/// files in any encoding, but a protobuf string that is not UTF-8 cannot be read by its receiver.
std::string ValidUtf8(std::string_view text);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_UTF8_H_
