#include "core/motion/io/clip_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

#include "core/motion/io/amc_reader.h"
#include "core/motion/io/asf_reader.h"
#include "core/motion/io/bvh_reader.h"
#include "core/motion/io/cmu_text_reader.h"
#include "core/motion/io/deepmimic_reader.h"
#include "core/motion/io/npz_reader.h"
#include "core/motion/io/raw_clip.h"
#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

namespace fs = std::filesystem;

struct FormatName {
  ClipFormat format;
  const char* name;
};
constexpr std::array kFormatNames = {
    FormatName{ClipFormat::kUnknown, "unknown"},
    FormatName{ClipFormat::kBvh, "bvh"},
    FormatName{ClipFormat::kAmc, "amc"},
    FormatName{ClipFormat::kNpz, "npz"},
    FormatName{ClipFormat::kCmuText, "cmu_text"},
    FormatName{ClipFormat::kDeepMimic, "deepmimic_json"},
};

std::string KnownFormats() {
  std::string names;
  for (const FormatName& entry : kFormatNames) {
    if (entry.format == ClipFormat::kUnknown) continue;
    names += names.empty() ? "" : ", ";
    names += entry.name;
  }
  return names;
}

// What ASF text is called in messages.
struct SkeletonSource {
  std::string_view name;
  std::string_view data;
};

StatusOr<RawClip> ReadWithSkeleton(std::string_view name, std::string_view data,
                                   const SkeletonSource& skeleton) {
  if (skeleton.data.empty()) {
    return base::InvalidArgument(
        "MISSING_SKELETON", "skeleton",
        fmt::format("{}: an AMC file needs the ASF file of its skeleton, got none", name));
  }
  POISE_ASSIGN_OR_RETURN(const AsfSkeleton asf, ReadAsf(skeleton.name, skeleton.data));
  return ReadAmc(name, data, asf);
}

StatusOr<RawClip> ReadRaw(std::string_view name, std::string_view data, ClipFormat format,
                          const SkeletonSource& skeleton) {
  switch (format) {
    case ClipFormat::kBvh:
      return ReadBvh(name, data);
    case ClipFormat::kAmc:
      return ReadWithSkeleton(name, data, skeleton);
    case ClipFormat::kCmuText:
      return ReadCmuText(name, data);
    case ClipFormat::kNpz:
      return ReadNpz(name, data);
    case ClipFormat::kDeepMimic:
      return ReadDeepMimic(name, data);
    case ClipFormat::kUnknown:
      break;
  }
  return base::InvalidArgument(
      "UNKNOWN_FORMAT", "format",
      fmt::format("{}: neither its name nor its first bytes ({}) tell a format; expected one of {}",
                  name, Quoted(data.substr(0, 16)), KnownFormats()));
}

StatusOr<ClipFile> Decode(std::string_view name, std::string_view data, ClipFormat format,
                          const ClipHints& hints, const SkeletonSource& skeleton) {
  if (format == ClipFormat::kUnknown) format = DetectClipFormat(name, data);
  POISE_ASSIGN_OR_RETURN(RawClip raw, ReadRaw(name, data, format, skeleton));
  return ToClipFile(name, std::move(raw), format, hints);
}

StatusOr<std::string> ReadBytes(const fs::path& path) {
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (!file || fs::is_directory(path, ignored)) {
    return base::NotFound("FILE_NOT_FOUND", "",
                          fmt::format("{}: no such file, or it cannot be read", path.string()));
  }
  return std::string(std::istreambuf_iterator<char>(file), {});
}

// The ASF whose name is the longest beginning of the AMC's; empty when there is none.
fs::path FindSkeleton(const fs::path& amc) {
  const std::string stem = amc.stem().string();
  const fs::path folder = amc.has_parent_path() ? amc.parent_path() : fs::path(".");
  for (const fs::path& place : {folder, folder / ".." / "skeletons"}) {
    fs::path best;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, none)) {
      const fs::path& path = entry.path();
      const std::string candidate = path.stem().string();
      if (EqualsIgnoringCase(path.extension().string(), ".asf") && stem.starts_with(candidate) &&
          candidate.size() > best.stem().string().size()) {
        best = path;
      }
    }
    if (!best.empty()) return best;
  }
  return {};
}

}  // namespace

const char* ClipFormatName(ClipFormat format) {
  for (const FormatName& entry : kFormatNames) {
    if (entry.format == format) return entry.name;
  }
  return "unknown";
}

SourceConvention UsualBvhConvention() {
  SourceConvention usual;
  usual.unit_m = 0.01;
  return usual;
}

StatusOr<ClipFormat> ParseClipFormat(std::string_view name) {
  for (const FormatName& entry : kFormatNames) {
    if (name == entry.name) return entry.format;
  }
  return base::InvalidArgument(
      "UNKNOWN_FORMAT", "format",
      fmt::format("unknown clip format {}; expected one of {}", Quoted(name), KnownFormats()));
}

ClipFormat DetectClipFormat(std::string_view file_name, std::string_view data) {
  TextScanner scanner(file_name, "", data.substr(0, 4096));
  scanner.NextLine();
  const std::string_view line = scanner.PeekRestOfLine();
  if (data.starts_with("PK\x03\x04")) return ClipFormat::kNpz;
  if (EqualsIgnoringCase(line, "HIERARCHY")) return ClipFormat::kBvh;
  const auto ends_with = [&](std::string_view ending) {
    return file_name.size() >= ending.size() &&
           EqualsIgnoringCase(file_name.substr(file_name.size() - ending.size()), ending);
  };
  if (ends_with(".bvh")) return ClipFormat::kBvh;
  if (ends_with(".amc")) return ClipFormat::kAmc;
  if (ends_with(".npz")) return ClipFormat::kNpz;
  if (line.starts_with("#!OML") || line.starts_with(":FULLY-SPECIFIED")) return ClipFormat::kAmc;
  if (line.starts_with('{') && data.substr(0, 4096).find("\"Frames\"") != std::string_view::npos) {
    return ClipFormat::kDeepMimic;
  }
  if (std::count(line.begin(), line.end(), ',') == kCmuTextColumns - 1) {
    return ClipFormat::kCmuText;
  }
  return ClipFormat::kUnknown;
}

StatusOr<ClipFile> DecodeClip(std::string_view name, std::string_view data, ClipFormat format,
                              const ClipHints& hints, std::string_view skeleton_data) {
  return Decode(name, data, format, hints, {"the ASF skeleton", skeleton_data});
}

StatusOr<ClipFile> ReadClipFile(const fs::path& path, const ClipHints& hints,
                                const fs::path& skeleton) {
  POISE_ASSIGN_OR_RETURN(const std::string data, ReadBytes(path));
  const std::string name = path.filename().string();
  const ClipFormat format = DetectClipFormat(name, data);
  if (format != ClipFormat::kAmc) return Decode(name, data, format, hints, {});
  const fs::path asf = skeleton.empty() ? FindSkeleton(path) : skeleton;
  if (asf.empty()) {
    return base::InvalidArgument(
        "MISSING_SKELETON", "skeleton",
        fmt::format("{}: found no ASF file whose name begins like it (HDM_<actor>.asf), neither "
                    "beside it nor in '../skeletons'; name one",
                    path.string()));
  }
  POISE_ASSIGN_OR_RETURN(const std::string asf_data, ReadBytes(asf));
  const std::string asf_name = asf.filename().string();
  return Decode(name, data, format, hints, {asf_name, asf_data});
}

}  // namespace poise::motion
