#include "core/motion/io/bvh_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/motion/io/bvh_hierarchy.h"
#include "core/motion/io/convention_detection.h"
#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
// Of the body's height: position channels that stay within it are an offset with its rounding.
constexpr double kStillness = 2e-4;

bool HasPosition(const std::vector<BvhChannel>& channels) {
  return std::any_of(channels.begin(), channels.end(),
                     [](const BvhChannel& channel) { return channel.is_position; });
}

// The joint's place and turn in its parent, from its columns.
void ReadJoint(const std::vector<BvhChannel>& channels, const double* columns, Vec3& position,
               Quat& rotation) {
  rotation = Quat::Identity();
  for (const BvhChannel& channel : channels) {
    const double value = *columns++;
    if (channel.is_position) {
      position[channel.axis] = value;
      continue;
    }
    const double half = 0.5 * kRadians * value;
    Quat turn(std::cos(half), 0, 0, 0);
    turn.vec()[channel.axis] = std::sin(half);
    rotation = rotation * turn;
  }
}

class MotionReader {
 public:
  MotionReader(TextScanner& scanner, BvhHierarchy hierarchy, size_t file_bytes)
      : scanner_(scanner), hierarchy_(std::move(hierarchy)), file_bytes_(file_bytes) {
    FindRootChain();
  }

  StatusOr<RawClip> Read() {
    POISE_RETURN_IF_ERROR(ReadHeader());
    std::vector<double> row(hierarchy_.num_columns);
    for (int64_t frame = 0; frame < num_frames_; ++frame) {
      if (!scanner_.NextLine()) {
        return scanner_.Error(
            fmt::format("the file ends after {} frames, 'Frames:' says {}", frame, num_frames_));
      }
      POISE_RETURN_IF_ERROR(scanner_.ReadRow(row, fmt::format("frame {}", frame)));
      POISE_RETURN_IF_ERROR(AddFrame(frame, row));
    }
    if (scanner_.NextLine()) {
      return scanner_.Expected(fmt::format("the end of the file after {} frames", num_frames_),
                               scanner_.RestOfLine());
    }
    FoldRootChain();
    clip_.joints = std::move(hierarchy_.joints);
    clip_.notes.insert(clip_.notes.begin(), hierarchy_.notes.begin(), hierarchy_.notes.end());
    for (const auto& channels : hierarchy_.channels) {
      std::vector<std::string>& names = clip_.channels.emplace_back();
      for (const BvhChannel& channel : channels) names.push_back(BvhChannelName(channel));
    }
    return std::move(clip_);
  }

 private:
  // Joints 0 to chain_length - 1 hang on each other and on nothing else does anything hang.
  void FindRootChain() {
    std::vector<int> children(hierarchy_.joints.size(), 0);
    for (const Joint& joint : hierarchy_.joints) {
      if (joint.parent >= 0) ++children[joint.parent];
    }
    chain_length_ = 1;
    while (children[chain_length_ - 1] == 1) ++chain_length_;
    chain_positions_.resize(chain_length_);
  }

  Status ReadHeader() {
    const auto expect = [&](std::string_view label) -> Status {
      // "Frames:12" and "Frames : 12" occur beside "Frames: 12".
      if (!scanner_.NextLine()) return scanner_.Expected(fmt::format("'{}:'", label), "");
      const std::string_view found = scanner_.RestOfLine(':');
      if (!EqualsIgnoringCase(found, label)) {
        return scanner_.Expected(fmt::format("'{}:'", label), found);
      }
      scanner_.SkipCharacter(':');
      return absl::OkStatus();
    };
    POISE_RETURN_IF_ERROR(expect("Frames"));
    POISE_ASSIGN_OR_RETURN(num_frames_, scanner_.NextCount("Frames", Clip::kMaxFrames));
    if (num_frames_ == 0) return scanner_.Error("'Frames:' says 0, expected at least one frame");
    POISE_RETURN_IF_ERROR(CheckSize(scanner_.file(), scanner_.line_number(), num_frames_,
                                    hierarchy_.joints.size(), file_bytes_));
    POISE_RETURN_IF_ERROR(expect("Frame Time"));
    const std::string written(scanner_.PeekRestOfLine());
    POISE_ASSIGN_OR_RETURN(const double seconds, scanner_.NextNumber("Frame Time"));
    if (!(seconds >= 1e-4)) {
      return scanner_.Error(fmt::format(
          "Frame Time is {}, expected seconds from 0.0001 (10000 Hz) upwards", seconds));
    }
    clip_.frame_rate = {RateOfFrameTime(seconds, written),
                        fmt::format("from the frame time {} s", written)};
    // No more than the rest of the file can fill: a number and its blank are two bytes.
    const size_t most = scanner_.bytes_left() / (2 * hierarchy_.num_columns) + 1;
    const size_t frames = std::min<size_t>(num_frames_, most);
    clip_.root_positions.reserve(frames);
    clip_.rotations.reserve(frames * hierarchy_.joints.size());
    return absl::OkStatus();
  }

  Status AddFrame(int64_t frame, const std::vector<double>& row) {
    if (frame == 0) ReadRestOffsets(row);
    const double* columns = row.data();
    for (int joint = 0; joint < static_cast<int>(hierarchy_.joints.size()); ++joint) {
      const auto& channels = hierarchy_.channels[joint];
      Vec3 position = hierarchy_.joints[joint].offset;
      Quat rotation;
      ReadJoint(channels, columns, position, rotation);
      columns += channels.size();
      clip_.rotations.push_back(rotation);
      if (joint == 0) clip_.root_positions.push_back(position);
      if (joint == 0 || !has_position_[joint]) continue;
      if (joint < chain_length_) {
        chain_positions_[joint].push_back(position);
      } else if ((position - first_positions_[joint]).norm() > stillness_) {
        return base::InvalidArgument(
            "MOVING_JOINT_OFFSET", "",
            fmt::format("{}: line {}: frame {}: joint {} travels in its parent ({:.6g} units from "
                        "where it was in frame 0), expected only the root, or the one chain of "
                        "joints below it, to travel",
                        scanner_.file(), scanner_.line_number(), frame,
                        Quoted(hierarchy_.joints[joint].name),
                        (position - first_positions_[joint]).norm()));
      }
    }
    return absl::OkStatus();
  }

  // Takes the offsets of joints with position channels from the first frame.
  void ReadRestOffsets(const std::vector<double>& row) {
    const size_t joints = hierarchy_.joints.size();
    std::vector<Joint> placed = hierarchy_.joints;
    has_position_.resize(joints);
    const double* columns = row.data();
    for (size_t joint = 0; joint < joints; ++joint) {
      Quat unused;
      if (joint > 0) ReadJoint(hierarchy_.channels[joint], columns, placed[joint].offset, unused);
      has_position_[joint] = HasPosition(hierarchy_.channels[joint]);
      columns += hierarchy_.channels[joint].size();
    }
    stillness_ = kStillness * std::max(BodyHeight(placed), BodyHeight(hierarchy_.joints));
    int replaced = 0, kept = 0;
    first_positions_.resize(joints);
    for (size_t joint = 1; joint < joints; ++joint) {
      if (!has_position_[joint]) continue;
      first_positions_[joint] = placed[joint].offset;
      if (static_cast<int>(joint) < chain_length_) continue;  // decided when all frames are known
      Vec3& offset = hierarchy_.joints[joint].offset;
      if ((placed[joint].offset - offset).norm() <= stillness_) continue;
      if (placed[joint].offset.norm() <= stillness_) {
        ++kept;
      } else {
        offset = placed[joint].offset;
        ++replaced;
      }
    }
    if (replaced > 0) {
      clip_.notes.push_back(fmt::format(
          "position channels replace the OFFSET of {} joints, from which they differ", replaced));
    }
    if (kept > 0) {
      clip_.notes.push_back(
          fmt::format("position channels of {} joints are zero: their OFFSET stands", kept));
    }
  }

  // Whether a chain joint has to be folded: it travels, or stands elsewhere than its OFFSET.
  bool Travels(int joint) const {
    if (chain_positions_[joint].empty()) return false;
    const Vec3& first = chain_positions_[joint].front();
    const bool displaced =
        (first - hierarchy_.joints[joint].offset).norm() > stillness_ && first.norm() > stillness_;
    return displaced || std::any_of(chain_positions_[joint].begin(), chain_positions_[joint].end(),
                                    [&](const Vec3& position) {
                                      return (position - first).norm() > stillness_;
                                    });
  }

  void FoldRootChain() {
    int last = chain_length_ - 1;
    while (last > 0 && !Travels(last)) --last;
    if (last == 0) return;
    const size_t joints = hierarchy_.joints.size();
    std::vector<Quat> folded;
    folded.reserve(clip_.root_positions.size() * (joints - last));
    for (size_t frame = 0; frame < clip_.root_positions.size(); ++frame) {
      const Quat* local = clip_.rotations.data() + frame * joints;
      Vec3& position = clip_.root_positions[frame];
      Quat rotation = local[0];
      for (int joint = 1; joint <= last; ++joint) {
        position += rotation * (chain_positions_[joint].empty() ? hierarchy_.joints[joint].offset
                                                                : chain_positions_[joint][frame]);
        rotation = rotation * local[joint];
      }
      folded.push_back(rotation);
      folded.insert(folded.end(), local + last + 1, local + joints);
    }
    clip_.rotations = std::move(folded);
    clip_.notes.push_back(fmt::format("root: {}, with the {} above folded into it",
                                      Quoted(hierarchy_.joints[last].name),
                                      last == 1 ? "joint" : fmt::format("{} joints", last)));
    hierarchy_.joints.erase(hierarchy_.joints.begin(), hierarchy_.joints.begin() + last);
    hierarchy_.channels.erase(hierarchy_.channels.begin(), hierarchy_.channels.begin() + last);
    for (Joint& joint : hierarchy_.joints) joint.parent = std::max(joint.parent - last, -1);
  }

  TextScanner& scanner_;
  BvhHierarchy hierarchy_;
  const size_t file_bytes_;
  RawClip clip_;
  int64_t num_frames_ = 0;
  int chain_length_ = 1;
  std::vector<std::vector<Vec3>> chain_positions_;  // (chain, frames), empty without channels
  std::vector<bool> has_position_;                  // (joints)
  std::vector<Vec3> first_positions_;               // (joints)
  double stillness_ = 0;                            // [file units]
};

}  // namespace

StatusOr<RawClip> ReadBvh(std::string_view file, std::string_view data) {
  TextScanner scanner(file, "MALFORMED_BVH", data);
  POISE_ASSIGN_OR_RETURN(BvhHierarchy hierarchy, ReadBvhHierarchy(scanner));
  return MotionReader(scanner, std::move(hierarchy), data.size()).Read();
}

}  // namespace poise::motion
