#include "core/motion/io/npz_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/motion/io/npy_array.h"
#include "core/motion/io/smpl_skeleton.h"
#include "core/motion/io/text_scanner.h"
#include "core/motion/io/zip_archive.h"

namespace poise::motion {
namespace {

constexpr int64_t kBodyNumbers = 3 * kNumSmplJoints;

struct Array {
  NpyHeader header;
  std::vector<double> numbers;  // row-major

  int64_t rows() const { return header.shape.size() == 2 ? header.shape[0] : 0; }
  int64_t columns() const { return header.shape.size() == 2 ? header.shape[1] : 0; }
};

class NpzReader {
 public:
  NpzReader(std::string_view file, size_t file_bytes, const ZipArchive& archive)
      : file_(file), file_bytes_(file_bytes), archive_(archive) {}

  StatusOr<RawClip> Read() {
    POISE_ASSIGN_OR_RETURN(const Array poses, ReadArray("poses"));
    POISE_ASSIGN_OR_RETURN(const Array trans, ReadArray("trans"));
    POISE_RETURN_IF_ERROR(CheckShapes(poses, trans));
    POISE_RETURN_IF_ERROR(CheckSize(Where("poses"), 0, poses.rows(), kNumSmplJoints, file_bytes_));
    RawClip clip;
    POISE_ASSIGN_OR_RETURN(clip.frame_rate, ReadRate());
    clip.joints = SmplJoints();
    for (int64_t frame = 0; frame < poses.rows(); ++frame) {
      const double* position = &trans.numbers[3 * frame];
      clip.root_positions.emplace_back(position[0], position[1], position[2]);
      const double* vectors = &poses.numbers[frame * poses.columns()];
      for (int joint = 0; joint < kNumSmplJoints; ++joint, vectors += 3) {
        clip.rotations.push_back(
            math::FromRotationVector(Vec3(vectors[0], vectors[1], vectors[2])));
      }
    }
    clip.unit_m = {1.0, "the unit of AMASS files"};
    clip.up = {UpAxis::kZ, "as in AMASS files"};
    clip.notes = {
        "bones: the default SMPL body of 1.70 m; 'betas' need the licensed body model and are not "
        "read",
        "'trans' is taken for the pelvis's position"};
    if (poses.columns() > kBodyNumbers) {
      clip.notes.push_back(
          fmt::format("joints: the {} of the body; {} numbers a frame beyond "
                      "them (hands, face) are not read",
                      kNumSmplJoints, poses.columns() - kBodyNumbers));
    }
    return clip;
  }

 private:
  std::string Where(std::string_view name) const {
    return fmt::format("{}: entry '{}.npy'", file_, name);
  }

  Status Malformed(std::string_view name, std::string_view problem) const {
    return base::InvalidArgument("MALFORMED_NPZ", "", fmt::format("{}: {}", Where(name), problem));
  }

  StatusOr<std::optional<Array>> FindArray(std::string_view name) const {
    POISE_ASSIGN_OR_RETURN(const auto bytes, archive_.Read(fmt::format("{}.npy", name)));
    if (!bytes) return std::nullopt;
    Array array;
    POISE_ASSIGN_OR_RETURN(array.header, ParseNpyHeader(Where(name), *bytes));
    POISE_ASSIGN_OR_RETURN(array.numbers, ReadNpyNumbers(Where(name), array.header, *bytes));
    return array;
  }

  StatusOr<Array> ReadArray(std::string_view name) const {
    POISE_ASSIGN_OR_RETURN(auto array, FindArray(name));
    if (!array) return Malformed(name, "expected this entry, found none");
    return *std::move(array);
  }

  Status CheckShapes(const Array& poses, const Array& trans) const {
    if (poses.rows() < 1 || poses.columns() < kBodyNumbers || poses.columns() % 3 != 0) {
      return Malformed("poses",
                       fmt::format("expected the shape (frames, 3 x joints), at least (1, {}), "
                                   "found ({})",
                                   kBodyNumbers, fmt::join(poses.header.shape, ", ")));
    }
    if (trans.rows() != poses.rows() || trans.columns() != 3) {
      return Malformed("trans", fmt::format("expected the shape ({}, 3), as many frames as "
                                            "'poses', found ({})",
                                            poses.rows(), fmt::join(trans.header.shape, ", ")));
    }
    return absl::OkStatus();
  }

  StatusOr<RawClip::Stated<double>> ReadRate() const {
    for (const char* name : {"mocap_framerate", "mocap_frame_rate"}) {
      POISE_ASSIGN_OR_RETURN(const auto array, FindArray(name));
      if (!array) continue;
      if (array->numbers.size() != 1 || !(array->numbers[0] > 0)) {
        return Malformed(name,
                         fmt::format("expected one positive number, found {} of the shape "
                                     "({})",
                                     array->numbers.size(), fmt::join(array->header.shape, ", ")));
      }
      return RawClip::Stated<double>{array->numbers[0], fmt::format("from '{}'", name)};
    }
    return Malformed("mocap_framerate",
                     "expected this entry or 'mocap_frame_rate.npy', found "
                     "neither");
  }

  std::string_view file_;
  const size_t file_bytes_;
  const ZipArchive& archive_;
};

}  // namespace

StatusOr<RawClip> ReadNpz(std::string_view file, std::string_view data) {
  POISE_ASSIGN_OR_RETURN(const ZipArchive archive, ZipArchive::Open(file, data));
  return NpzReader(file, data.size(), archive).Read();
}

}  // namespace poise::motion
