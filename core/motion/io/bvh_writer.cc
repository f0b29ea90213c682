#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>

#include "core/motion/io/bvh_hierarchy.h"
#include "core/motion/io/clip_file.h"

namespace poise::motion {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
// Ten digits keep 1e-8 degrees and, in a room, less than a micrometre.
constexpr int kDigits = 10;
// A rotation that a joint's few channels miss by more [rad] gets all three.
constexpr double kMissed = 1e-7;

const std::vector<BvhChannel> kPositions = {{true, 0}, {true, 1}, {true, 2}};
const std::vector<BvhChannel> kRotations = {{false, 2}, {false, 0}, {false, 1}};

void AppendNumber(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::general, kDigits);
  text.append(digits.data(), end.ptr);
}

// How a joint's rotation is written: `order` gives three angles, of which the first `written` are
// in the file (the others are zero).
struct RotationLayout {
  math::EulerOrder order = math::kZXY;
  int written = 3;
};

// Undoes what reading did to a Z-up file: Y up -> Z up.
Vec3 ToFileAxes(const Vec3& v, bool turned) { return turned ? Vec3(v.x(), -v.z(), v.y()) : v; }

class BvhEncoder {
 public:
  BvhEncoder(const Clip& clip, const SourceConvention& convention)
      : clip_(clip),
        unit_m_(convention.unit_m),
        z_up_(convention.up == UpAxis::kZ),
        turn_all_(z_up_ && convention.rest_pose_turned) {
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      ChooseChannels(joint, convention);
    }
  }

  std::string Encode() {
    text_.reserve(static_cast<size_t>(clip_.num_frames()) * clip_.num_joints() * 36 + 4096);
    text_ += "HIERARCHY\n";
    WriteJoint();
    text_ += fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", clip_.num_frames(),
                         1 / clip_.frame_rate());
    for (int frame = 0; frame < clip_.num_frames(); ++frame) WriteFrame(frame);
    return std::move(text_);
  }

 private:
  // Takes over the source's channels where they can carry the motion, else adds what is missing.
  void ChooseChannels(int joint, const SourceConvention& convention) {
    std::vector<BvhChannel> positions, rotations;
    bool rotation_first = false;
    const bool known = convention.channels.size() == static_cast<size_t>(clip_.num_joints());
    if (known) {
      for (const std::string& name : convention.channels[joint]) {
        const auto channel = ParseBvhChannel(name);
        if (!channel) continue;
        if (!channel->is_position && positions.empty()) rotation_first = true;
        (channel->is_position ? positions : rotations).push_back(*channel);
      }
    }
    if (joint == 0 && positions.size() != 3) positions = kPositions;
    RotationLayout layout;
    if (known) {
      const auto found = LayoutOf(rotations);
      if (found && CanCarry(joint, *found)) {
        layout = *found;
      } else {
        rotations = kRotations;
      }
    } else {
      rotations = kRotations;
    }
    layouts_.push_back(layout);
    std::vector<BvhChannel>& channels = channels_.emplace_back();
    const auto append = [&](const std::vector<BvhChannel>& some) {
      channels.insert(channels.end(), some.begin(), some.end());
    };
    append(rotation_first ? rotations : positions);
    append(rotation_first ? positions : rotations);
  }

  // Three angles for up to three channels; nullopt when they are no Euler order.
  static std::optional<RotationLayout> LayoutOf(const std::vector<BvhChannel>& rotations) {
    if (rotations.size() > 3) return std::nullopt;
    RotationLayout layout;
    layout.written = static_cast<int>(rotations.size());
    std::array<int, 3>& axes = layout.order.axes;
    for (int i = 0; i < 3; ++i) {
      if (i < layout.written) {
        axes[i] = rotations[i].axis;
      } else {
        // An axis that is not there yet.
        axes[i] = i == 0 ? 0 : i == 1 ? (axes[0] + 1) % 3 : 3 - axes[0] - axes[1];
      }
      if (i > 0 && axes[i] == axes[i - 1]) return std::nullopt;
    }
    return layout;
  }

  bool CanCarry(int joint, const RotationLayout& layout) const {
    if (layout.written == 3) return true;
    for (int frame = 0; frame < clip_.num_frames(); ++frame) {
      const Vec3 angles = math::ToEuler(FileRotation(frame, joint), layout.order);
      for (int i = layout.written; i < 3; ++i) {
        if (std::abs(angles[i]) > kMissed) return false;
      }
    }
    return true;
  }

  Quat FileRotation(int frame, int joint) const {
    const Quat& q = clip_.rotation(frame, joint);
    if (turn_all_) return Quat(q.w(), q.x(), -q.z(), q.y());
    if (!z_up_ || joint != 0) return q;
    const double half = std::numbers::sqrt2 / 2;
    return Quat(half, half, 0, 0) * q;  // +90 degrees about X
  }

  void WriteOffset(const Vec3& offset) {
    const Vec3 in_file = ToFileAxes(offset, turn_all_) / unit_m_;
    text_ += "OFFSET";
    for (int axis = 0; axis < 3; ++axis) {
      text_ += ' ';
      AppendNumber(text_, in_file[axis]);
    }
    text_ += '\n';
  }

  void Indent(size_t depth) { text_.append(2 * depth, ' '); }

  // The tree without recursion: joints stand in depth-first order only in a BVH file, so children
  // are looked up.
  void WriteJoint() {
    struct Open {
      int joint;
      size_t next_child = 0;
    };
    std::vector<Open> open = {{0}};
    OpenBrace(0, 0);
    while (!open.empty()) {
      const std::span<const int> children = clip_.skeleton()->children(open.back().joint);
      if (open.back().next_child < children.size()) {
        const int child = children[open.back().next_child++];
        OpenBrace(child, open.size());
        open.push_back({child});
        continue;
      }
      CloseBrace(open.back().joint, open.size());
      open.pop_back();
    }
  }

  void OpenBrace(int joint, size_t depth) {
    order_.push_back(joint);
    Indent(depth);
    text_ += depth == 0 ? "ROOT " : "JOINT ";
    text_ += SafeName(joint);
    text_ += '\n';
    Indent(depth);
    text_ += "{\n";
    Indent(depth + 1);
    WriteOffset(clip_.skeleton()->joint(joint).offset);
    if (channels_[joint].empty()) return;
    Indent(depth + 1);
    text_ += fmt::format("CHANNELS {}", channels_[joint].size());
    for (const BvhChannel& channel : channels_[joint]) text_ += " " + BvhChannelName(channel);
    text_ += '\n';
  }

  void CloseBrace(int joint, size_t depth) {
    const Joint& closing = clip_.skeleton()->joint(joint);
    // A joint without children needs an end site; programs refuse a file without.
    if (closing.end_site || clip_.skeleton()->children(joint).empty()) {
      Indent(depth);
      text_ += "End Site\n";
      Indent(depth);
      text_ += "{\n";
      Indent(depth + 1);
      WriteOffset(closing.end_site.value_or(Vec3::Zero()));
      Indent(depth);
      text_ += "}\n";
    }
    Indent(depth - 1);
    text_ += "}\n";
  }

  // A name as the file can hold it: on one line and without braces.
  std::string SafeName(int joint) const {
    std::string name = clip_.skeleton()->joint(joint).name;
    for (char& c : name) {
      if (static_cast<unsigned char>(c) < 0x20 || c == '{' || c == '}') c = '_';
    }
    const bool blank_ends = name.empty() || name.front() == ' ' || name.back() == ' ';
    return blank_ends ? fmt::format("joint_{}", joint) : name;
  }

  void WriteFrame(int frame) {
    const char* blank = "";
    for (const int joint : order_) {
      const Vec3 angles =
          kDegrees * math::ToEuler(FileRotation(frame, joint), layouts_[joint].order);
      const Vec3 position =
          (joint == 0 ? ToFileAxes(clip_.root_position(frame), z_up_)
                      : ToFileAxes(clip_.skeleton()->joint(joint).offset, turn_all_)) /
          unit_m_;
      int angle = 0;
      for (const BvhChannel& channel : channels_[joint]) {
        text_ += blank;
        blank = " ";
        AppendNumber(text_, channel.is_position ? position[channel.axis] : angles[angle++]);
      }
    }
    text_ += '\n';
  }

  const Clip& clip_;
  const double unit_m_;
  const bool z_up_, turn_all_;
  std::vector<std::vector<BvhChannel>> channels_;  // (joints)
  std::vector<RotationLayout> layouts_;            // (joints)
  std::vector<int> order_;                         // joints as they stand in the file
  std::string text_;
};

}  // namespace

std::string EncodeBvh(const Clip& clip, const SourceConvention& convention) {
  return BvhEncoder(clip, convention).Encode();
}

Status WriteBvhFile(const std::filesystem::path& path, const Clip& clip,
                    const SourceConvention& convention) {
  const std::string text = EncodeBvh(clip, convention);
  std::ofstream file(path, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (file.good()) return absl::OkStatus();
  return base::FailedPrecondition(
      "CANNOT_WRITE", "",
      fmt::format("{}: cannot be written; does its folder exist, and is there room?",
                  path.string()));
}

}  // namespace poise::motion
