#ifndef POISE_PROTO_CONVERT_BYTES_FIELD_H_
#define POISE_PROTO_CONVERT_BYTES_FIELD_H_

#include <google/protobuf/io/coded_stream.h>

#include <cstddef>
#include <cstdint>

/// Fields of the wire format whose value is a number of bytes (strings, messages, packed numbers):
/// a tag, the number, the bytes. For messages that are too large to be made twice.
/// Source: the encoding guide of Protocol Buffers, "Length-Delimited Records".
namespace poise::convert {

inline uint32_t BytesFieldTag(int field) { return static_cast<uint32_t>(field) << 3 | 2; }

/// Of the whole field. `bytes` < 2^31, as in any message.
inline size_t BytesFieldSize(int field, size_t bytes) {
  using google::protobuf::io::CodedOutputStream;
  return CodedOutputStream::VarintSize32(BytesFieldTag(field)) +
         CodedOutputStream::VarintSize32(static_cast<uint32_t>(bytes)) + bytes;
}

/// Writes what comes before the bytes; returns where they go.
inline uint8_t* WriteBytesFieldHead(int field, size_t bytes, uint8_t* out) {
  using google::protobuf::io::CodedOutputStream;
  out = CodedOutputStream::WriteTagToArray(BytesFieldTag(field), out);
  return CodedOutputStream::WriteVarint32ToArray(static_cast<uint32_t>(bytes), out);
}

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_BYTES_FIELD_H_
