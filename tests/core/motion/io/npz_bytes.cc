#include "tests/core/motion/io/npz_bytes.h"

#include <fmt/format.h>
#include <zip.h>

#include <cstdint>

namespace poise::testing {
namespace {

template <typename T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

uint32_t Crc32(std::string_view data) {
  uint32_t crc = 0xffffffff;
  for (const char c : data) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

// What local header and central directory share; sizes move to the extra field in zip64.
void AppendEntryHead(std::string& bytes, const ZipEntry& entry, bool zip64) {
  const auto size = static_cast<uint32_t>(entry.data.size());
  Append<uint16_t>(bytes, zip64 ? 45 : 20);
  Append<uint16_t>(bytes, 0);  // flags
  Append<uint16_t>(bytes, 0);  // stored
  Append<uint32_t>(bytes, 0x00210000);
  Append<uint32_t>(bytes, Crc32(entry.data));
  Append<uint32_t>(bytes, zip64 ? 0xffffffff : size);
  Append<uint32_t>(bytes, zip64 ? 0xffffffff : size);
  Append<uint16_t>(bytes, static_cast<uint16_t>(entry.name.size()));
  Append<uint16_t>(bytes, zip64 ? 20 : 0);
}

void AppendExtra(std::string& bytes, const ZipEntry& entry, bool zip64) {
  if (!zip64) return;
  Append<uint16_t>(bytes, 1);
  Append<uint16_t>(bytes, 16);
  Append<uint64_t>(bytes, entry.data.size());
  Append<uint64_t>(bytes, entry.data.size());
}

std::string Stored(const std::vector<ZipEntry>& entries, bool zip64) {
  std::string bytes, directory;
  for (const ZipEntry& entry : entries) {
    Append<uint32_t>(directory, 0x02014b50);
    Append<uint16_t>(directory, 45);
    AppendEntryHead(directory, entry, zip64);
    Append<uint16_t>(directory, 0);  // comment
    Append<uint16_t>(directory, 0);  // disk
    Append<uint16_t>(directory, 0);
    Append<uint32_t>(directory, 0);
    Append<uint32_t>(directory, static_cast<uint32_t>(bytes.size()));
    directory += entry.name;
    AppendExtra(directory, entry, zip64);
    Append<uint32_t>(bytes, 0x04034b50);
    AppendEntryHead(bytes, entry, zip64);
    bytes += entry.name;
    AppendExtra(bytes, entry, zip64);
    bytes += entry.data;
  }
  const auto offset = static_cast<uint32_t>(bytes.size());
  bytes += directory;
  Append<uint32_t>(bytes, 0x06054b50);
  Append<uint32_t>(bytes, 0);  // disks
  Append<uint16_t>(bytes, static_cast<uint16_t>(entries.size()));
  Append<uint16_t>(bytes, static_cast<uint16_t>(entries.size()));
  Append<uint32_t>(bytes, static_cast<uint32_t>(directory.size()));
  Append<uint32_t>(bytes, offset);
  Append<uint16_t>(bytes, 0);
  return bytes;
}

std::string Deflated(const std::vector<ZipEntry>& entries) {
  zip_source_t* buffer = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  zip_source_keep(buffer);
  zip_t* zip = zip_open_from_source(buffer, ZIP_TRUNCATE, nullptr);
  for (const ZipEntry& entry : entries) {
    zip_source_t* data = zip_source_buffer(zip, entry.data.data(), entry.data.size(), 0);
    zip_file_add(zip, entry.name.c_str(), data, ZIP_FL_OVERWRITE);
  }
  zip_close(zip);
  zip_source_open(buffer);
  zip_source_seek(buffer, 0, SEEK_END);
  std::string bytes(zip_source_tell(buffer), '\0');
  zip_source_seek(buffer, 0, SEEK_SET);
  zip_source_read(buffer, bytes.data(), bytes.size());
  zip_source_close(buffer);
  zip_source_free(buffer);
  return bytes;
}

}  // namespace

std::string Npy(std::string_view type, std::string_view shape, std::string_view data, int version,
                bool fortran_order) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}", type,
                                   fortran_order ? "True" : "False", shape);
  header += std::string(64 - (header.size() + 13) % 64, ' ') + "\n";
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  if (version == 1) {
    Append<uint16_t>(bytes, static_cast<uint16_t>(header.size()));
  } else {
    Append<uint32_t>(bytes, static_cast<uint32_t>(header.size()));
  }
  return bytes + header + std::string(data);
}

std::string Zip(const std::vector<ZipEntry>& entries, Packing packing) {
  return packing == Packing::kDeflated ? Deflated(entries)
                                       : Stored(entries, packing == Packing::kStoredZip64);
}

}  // namespace poise::testing
