#include "core/motion/io/amc_reader.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <numbers>
#include <unordered_map>

#include "core/motion/io/convention_detection.h"
#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

constexpr double kUsualRate = 120;  // [Hz]
constexpr double kInch = 0.0254;    // [m]

RawClip::Stated<double> RateInName(std::string_view file) {
  file = file.substr(0, file.rfind('.'));
  const std::string_view last = file.substr(file.rfind('_') + 1);
  int rate = 0;
  const auto [stop, error] = std::from_chars(last.data(), last.data() + last.size(), rate);
  const bool whole = error == std::errc() && stop == last.data() + last.size();
  if (whole && last.size() < file.size() && rate >= 24 && rate <= 1000) {
    return {static_cast<double>(rate), fmt::format("from '_{}' at the end of its name", rate)};
  }
  return {kUsualRate, "assumed as in HDM05 and CMU; neither file nor name says"};
}

class AmcReader {
 public:
  AmcReader(std::string_view file, std::string_view data, const AsfSkeleton& asf)
      : scanner_(file, "MALFORMED_AMC", data), file_bytes_(data.size()), asf_(asf) {
    for (size_t i = 0; i < asf.bones.size(); ++i) {
      bone_of_name_[asf.bones[i].name] = static_cast<int>(i);
    }
    clip_.joints = asf.Joints();
  }

  StatusOr<RawClip> Read() {
    while (scanner_.NextLine()) {
      const std::string_view word = scanner_.NextWordOfLine();
      if (word.starts_with('#')) continue;
      if (word.starts_with(':')) {
        if (EqualsIgnoringCase(word, ":DEGREES")) degrees_ = true;
        if (EqualsIgnoringCase(word, ":RADIANS")) degrees_ = false;
        continue;
      }
      POISE_RETURN_IF_ERROR(IsFrameNumber(word) ? BeginFrame(word) : ReadBone(word));
    }
    POISE_RETURN_IF_ERROR(FinishFrame());
    if (clip_.root_positions.empty()) return scanner_.Expected("a frame that begins with '1'", "");
    clip_.unit_m = {
        kInch / asf_.length_unit,
        fmt::format("since the ASF says length {:.6g} and the body is then about "
                    "{:.2f} m tall",
                    asf_.length_unit, BodyHeight(clip_.joints) * kInch / asf_.length_unit)};
    clip_.frame_rate = RateInName(scanner_.file());
    return std::move(clip_);
  }

 private:
  static bool IsFrameNumber(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
  }

  Status BeginFrame(std::string_view word) {
    POISE_RETURN_IF_ERROR(FinishFrame());
    int64_t number = 0;
    std::from_chars(word.data(), word.data() + word.size(), number);
    const int64_t expected = first_number_ + static_cast<int64_t>(clip_.root_positions.size());
    if (clip_.root_positions.empty()) {
      first_number_ = number;
    } else if (number != expected) {
      return scanner_.Expected(fmt::format("frame number {}", expected), word);
    }
    POISE_RETURN_IF_ERROR(CheckSize(scanner_.file(), scanner_.line_number(),
                                    clip_.root_positions.size() + 1, clip_.joints.size(),
                                    file_bytes_));
    clip_.root_positions.push_back(asf_.root_position);
    clip_.rotations.resize(clip_.rotations.size() + clip_.joints.size(), Quat::Identity());
    seen_.assign(clip_.joints.size(), false);
    return absl::OkStatus();
  }

  // Every bone that can move must have moved, or the pose is not known.
  Status FinishFrame() {
    for (size_t bone = 0; bone < seen_.size(); ++bone) {
      if (seen_[bone] || asf_.bones[bone].dofs.empty()) continue;
      return scanner_.Error(fmt::format("frame {} ends without bone '{}', expected its {} numbers",
                                        FrameNumber(), asf_.bones[bone].name,
                                        asf_.bones[bone].dofs.size()));
    }
    return absl::OkStatus();
  }

  Status ReadBone(std::string_view name) {
    if (clip_.root_positions.empty()) {
      return scanner_.Expected("a frame number before the first bone", name);
    }
    const auto found = bone_of_name_.find(std::string(name));
    if (found == bone_of_name_.end()) return scanner_.Expected("a bone of the ASF", name);
    const int index = found->second;
    const AsfBone& bone = asf_.bones[index];
    if (seen_[index]) {
      return scanner_.Error(
          fmt::format("bone {} twice in frame {}, expected once", Quoted(name), FrameNumber()));
    }
    seen_[index] = true;
    std::array<double, 8> row;
    const std::span<double> numbers(row.data(), bone.dofs.size());
    POISE_RETURN_IF_ERROR(
        scanner_.ReadRow(numbers, fmt::format("frame {}, bone {}", FrameNumber(), Quoted(name))));
    Vec3 angles = Vec3::Zero(), translation = Vec3::Zero();
    for (size_t i = 0; i < numbers.size(); ++i) {
      (bone.dofs[i].is_position ? translation : angles)[bone.dofs[i].axis] = numbers[i];
    }
    return Move(index, angles, translation);
  }

  Status Move(int index, const Vec3& angles, const Vec3& translation) {
    const AsfBone& bone = asf_.bones[index];
    if (index == 0) {
      clip_.root_positions.back() += translation;
    } else if (translation != Vec3::Zero()) {
      return base::InvalidArgument(
          "MOVING_JOINT_OFFSET", "",
          fmt::format("{}: line {}: frame {}: bone {} is shifted in its parent, expected "
                      "translations of the root only",
                      scanner_.file(), scanner_.line_number(), FrameNumber(), Quoted(bone.name)));
    }
    const auto& axes = bone.rotation_order.axes;
    const double radians = degrees_ ? std::numbers::pi / 180 : 1;
    const Quat motion = math::FromEuler(
        radians * Vec3(angles[axes[0]], angles[axes[1]], angles[axes[2]]), bone.rotation_order);
    clip_.rotations[clip_.rotations.size() - clip_.joints.size() + index] =
        bone.axis * motion * bone.axis.conjugate();
    return absl::OkStatus();
  }

  int64_t FrameNumber() const {
    return first_number_ + static_cast<int64_t>(clip_.root_positions.size()) - 1;
  }

  TextScanner scanner_;
  const size_t file_bytes_;
  const AsfSkeleton& asf_;
  std::unordered_map<std::string, int> bone_of_name_;
  RawClip clip_;
  std::vector<bool> seen_;  // (bones) in the current frame
  int64_t first_number_ = 1;
  bool degrees_ = true;
};

}  // namespace

StatusOr<RawClip> ReadAmc(std::string_view file, std::string_view data, const AsfSkeleton& asf) {
  return AmcReader(file, data, asf).Read();
}

}  // namespace poise::motion
