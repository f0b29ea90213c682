#include "core/motion/io/deepmimic_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/base/json.h"
#include "core/math/slerp.h"
#include "core/motion/io/convention_detection.h"

namespace poise::motion {
namespace {

constexpr size_t kFrameNumbers = 44;
constexpr double kSameStep = 0.01;    // steps that differ by less are one rate with its rounding
constexpr double kUnitLength = 1e-3;  // quaternions further from unit length are counted
constexpr double kShortestLength = 0.1;

using Frame = std::array<double, kFrameNumbers>;

// Where a joint's rotation stands in a frame: a quaternion, the angle of a hinge about local z, or
// nowhere (the fixed wrists).
enum class Motion { kQuaternion, kHinge, kFixed };
struct Source {
  const char* name;
  int parent;
  double x, y, z;  // [m] in the parent
  Motion motion;
  int column;
};
constexpr std::array<Source, 15> kJoints = {{
    {"pelvis", -1, 0, 0, 0, Motion::kQuaternion, 4},
    {"chest", 0, 0, 0.236151, 0, Motion::kQuaternion, 8},
    {"neck", 1, 0, 0.223894, 0, Motion::kQuaternion, 12},
    {"right_hip", 0, 0, 0, 0.084887, Motion::kQuaternion, 16},
    {"right_knee", 3, 0, -0.421546, 0, Motion::kHinge, 20},
    {"right_ankle", 4, 0, -0.40987, 0, Motion::kQuaternion, 21},
    {"right_shoulder", 1, -0.02405, 0.2435, 0.18311, Motion::kQuaternion, 25},
    {"right_elbow", 6, 0, -0.274788, 0, Motion::kHinge, 29},
    {"right_wrist", 7, 0, -0.258947, 0, Motion::kFixed, 0},
    {"left_hip", 0, 0, 0, -0.084887, Motion::kQuaternion, 30},
    {"left_knee", 9, 0, -0.421546, 0, Motion::kHinge, 34},
    {"left_ankle", 10, 0, -0.40987, 0, Motion::kQuaternion, 35},
    {"left_shoulder", 1, -0.02405, 0.2435, -0.18311, Motion::kQuaternion, 39},
    {"left_elbow", 12, 0, -0.274788, 0, Motion::kHinge, 43},
    {"left_wrist", 13, 0, -0.258947, 0, Motion::kFixed, 0},
}};

// Takes "Frames", an array of arrays of 44 numbers, out of the JSON as it is parsed: nothing else
// of the text is kept, whatever it holds.
class FrameHandler : public nlohmann::json_sax<nlohmann::json> {
 public:
  std::vector<Frame> frames;
  bool found = false;
  std::string problem;  // why parsing stopped

  bool null() override { return Other("null"); }
  bool boolean(bool) override { return Other("a truth value"); }
  bool string(string_t&) override { return Other("a text"); }
  bool binary(binary_t&) override { return Other("bytes"); }
  bool number_integer(number_integer_t value) override {
    return Number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return Number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return Number(value); }

  bool start_object(size_t) override {
    if (depth_ > 0 && !Other("an object")) return false;
    ++depth_;
    return true;
  }
  bool end_object() override { return Close(); }
  bool key(string_t& name) override {
    if (depth_ != 1) return true;
    in_frames_ = name == "Frames";
    if (in_frames_ && found) return Stop("has 'Frames' twice, expected once");
    found |= in_frames_;
    return true;
  }
  bool start_array(size_t) override {
    if (depth_ == 0) return Stop("expected an object with 'Frames', found an array");
    ++depth_;
    if (in_frames_ && depth_ > 3) return Other("an array");
    if (in_frames_ && depth_ == 3) column_ = 0;
    return true;
  }
  bool end_array() override {
    if (in_frames_ && depth_ == 3) {
      if (column_ != kFrameNumbers) {
        return Stop(fmt::format("frame {} has {} numbers, expected {}", frames.size(), column_,
                                kFrameNumbers));
      }
      frames.push_back(frame_);
    }
    return Close();
  }
  bool parse_error(size_t position, const std::string&,
                   const nlohmann::json::exception& error) override {
    const bool range = dynamic_cast<const nlohmann::json::out_of_range*>(&error) != nullptr;
    return Stop(fmt::format("byte {}: expected JSON, found {}", position,
                            range ? "a number out of range" : "something else"));
  }

 private:
  bool Stop(std::string_view why) {
    if (problem.empty()) problem = why;
    return false;
  }
  bool Close() {
    --depth_;
    return true;
  }
  bool Other(const char* what) {
    if (depth_ == 0) return Stop(fmt::format("expected an object with 'Frames', found {}", what));
    if (!in_frames_) return true;
    return Stop(
        fmt::format("frame {}: expected {} numbers, found {}", frames.size(), kFrameNumbers, what));
  }
  bool Number(double value) {
    if (depth_ == 0 || (in_frames_ && depth_ != 3)) return Other("a number");
    if (!in_frames_) return true;
    if (column_ < kFrameNumbers) frame_[column_] = value;
    ++column_;
    return true;
  }

  int depth_ = 0;
  bool in_frames_ = false;  // inside the value of "Frames"
  size_t column_ = 0;
  Frame frame_{};
};

class DeepMimicReader {
 public:
  DeepMimicReader(std::string_view file, size_t file_bytes) : file_(file), bytes_(file_bytes) {}

  StatusOr<RawClip> Read(const std::vector<Frame>& frames) {
    for (const Source& joint : kJoints) {
      clip_.joints.push_back(
          {joint.name, joint.parent, Vec3(joint.x, joint.y, joint.z), std::nullopt});
    }
    for (size_t i = 0; i < frames.size(); ++i) POISE_RETURN_IF_ERROR(AddFrame(i, frames[i]));
    if (not_unit_ > 0) {
      clip_.notes.push_back(
          fmt::format("{} quaternions were not of unit length (off by up to {:.2g}): normalised",
                      not_unit_, worst_length_));
    }
    POISE_RETURN_IF_ERROR(UnifyRate(frames));
    clip_.unit_m = {1.0, "the unit of DeepMimic's files"};
    clip_.up = {UpAxis::kY, "as in DeepMimic's files"};
    return std::move(clip_);
  }

 private:
  Status Malformed(size_t frame, std::string_view problem) const {
    return base::InvalidArgument("MALFORMED_DEEPMIMIC", "",
                                 fmt::format("{}: frame {}: {}", file_, frame, problem));
  }

  Status AddFrame(size_t index, const Frame& frame) {
    clip_.root_positions.emplace_back(frame[1], frame[2], frame[3]);
    for (const Source& joint : kJoints) {
      const double* column = &frame[joint.column];
      if (joint.motion == Motion::kFixed) {
        clip_.rotations.push_back(Quat::Identity());
      } else if (joint.motion == Motion::kHinge) {
        clip_.rotations.push_back(math::FromRotationVector(Vec3(0, 0, *column)));
      } else {
        Quat rotation(column[0], column[1], column[2], column[3]);
        const double length = rotation.norm();
        if (!(length > kShortestLength) || !std::isfinite(length)) {
          return Malformed(index, fmt::format("joint '{}': expected a quaternion of about unit "
                                              "length, found one of length {}",
                                              joint.name, length));
        }
        if (std::abs(length - 1) > kUnitLength) ++not_unit_;
        worst_length_ = std::max(worst_length_, std::abs(length - 1));
        rotation.coeffs() /= length;
        clip_.rotations.push_back(rotation);
      }
    }
    return absl::OkStatus();
  }

  // A frame lasts until the next; what the last one says of its own length is of no use.
  Status UnifyRate(const std::vector<Frame>& frames) {
    std::map<int64_t, int> steps;  // in units of 0.1 ms
    for (size_t i = 0; i + 1 < frames.size(); ++i) {
      if (!(frames[i][0] >= 1e-4 && frames[i][0] <= 10)) {
        return Malformed(
            i, fmt::format("expected a duration from 0.0001 to 10 s, found {}", frames[i][0]));
      }
      ++steps[std::llround(frames[i][0] * 1e4)];
    }
    if (steps.empty()) {
      clip_.frame_rate = {30, "assumed for a single frame"};
      return absl::OkStatus();
    }
    const auto most =
        std::max_element(steps.begin(), steps.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const double rounded = static_cast<double>(most->first) * 1e-4;
    const double rate = RateOfFrameTime(rounded, fmt::format("{:.4f}", rounded));
    clip_.frame_rate = {rate,
                        fmt::format("from the usual duration of its frames, {:.4f} s", rounded)};
    const auto differs = [&](int64_t step) {
      return std::abs(static_cast<double>(step) * 1e-4 - rounded) > kSameStep * rounded + 1e-4;
    };
    if (!differs(steps.begin()->first) && !differs(steps.rbegin()->first)) return absl::OkStatus();
    clip_.notes.push_back(fmt::format("durations: from {:.4f} to {:.4f} s; resampled to {:.6g} Hz",
                                      static_cast<double>(steps.begin()->first) * 1e-4,
                                      static_cast<double>(steps.rbegin()->first) * 1e-4, rate));
    return Resample(frames, rate);
  }

  Status Resample(const std::vector<Frame>& frames, double rate) {
    std::vector<double> times = {0};
    for (size_t i = 0; i + 1 < frames.size(); ++i) times.push_back(times.back() + frames[i][0]);
    const auto count = static_cast<int64_t>(std::floor(times.back() * rate + 1e-6)) + 1;
    const size_t joints = kJoints.size();
    POISE_RETURN_IF_ERROR(CheckSize(file_, 0, count, static_cast<int64_t>(joints), bytes_));
    std::vector<Vec3> positions;
    std::vector<Quat> rotations;
    size_t before = 0;
    for (int64_t i = 0; i < count; ++i) {
      const double time = static_cast<double>(i) / rate;
      while (before + 2 < times.size() && times[before + 1] <= time) ++before;
      const double u =
          std::clamp((time - times[before]) / (times[before + 1] - times[before]), 0.0, 1.0);
      positions.push_back((1 - u) * clip_.root_positions[before] +
                          u * clip_.root_positions[before + 1]);
      const math::SlerpAt slerp(u);
      for (size_t joint = 0; joint < joints; ++joint) {
        const Quat* from = &clip_.rotations[before * joints + joint];
        rotations.push_back(slerp(from[0], from[joints]));
      }
    }
    clip_.root_positions = std::move(positions);
    clip_.rotations = std::move(rotations);
    return absl::OkStatus();
  }

  std::string_view file_;
  size_t bytes_;
  RawClip clip_;
  int not_unit_ = 0;
  double worst_length_ = 0;
};

}  // namespace

StatusOr<RawClip> ReadDeepMimic(std::string_view file, std::string_view data) {
  FrameHandler handler;
  const bool parsed = nlohmann::json::sax_parse(data.begin(), data.end(), &handler);
  if (!parsed || handler.frames.empty()) {
    const std::string problem = !handler.problem.empty() ? handler.problem
                                : handler.found ? "'Frames' is empty, expected at least one frame"
                                                : "expected an object with 'Frames', found none";
    return base::InvalidArgument("MALFORMED_DEEPMIMIC", "", fmt::format("{}: {}", file, problem));
  }
  return DeepMimicReader(file, data.size()).Read(handler.frames);
}

}  // namespace poise::motion
