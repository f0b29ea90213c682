#include "core/motion/io/bvh_hierarchy.h"

#include <fmt/format.h>

#include <unordered_set>

namespace poise::motion {
namespace {

constexpr int kMostChannels = 12;  // of a joint; six are usual

StatusOr<Vec3> ReadOffset(TextScanner& scanner) {
  Vec3 offset;
  for (int axis = 0; axis < 3; ++axis) {
    POISE_ASSIGN_OR_RETURN(offset[axis], scanner.NextNumber(fmt::format("OFFSET {}", "xyz"[axis])));
  }
  return offset;
}

Status ExpectWord(TextScanner& scanner, std::string_view expected) {
  const std::string_view word = scanner.NextWord();
  if (EqualsIgnoringCase(word, expected)) return absl::OkStatus();
  return scanner.Expected(fmt::format("'{}'", expected), word);
}

// Parses the tree without recursion, so that no depth of nesting can exhaust the stack.
class HierarchyReader {
 public:
  explicit HierarchyReader(TextScanner& scanner) : scanner_(scanner) {}

  StatusOr<BvhHierarchy> Read() {
    POISE_RETURN_IF_ERROR(ExpectWord(scanner_, "HIERARCHY"));
    POISE_RETURN_IF_ERROR(ExpectWord(scanner_, "ROOT"));
    POISE_RETURN_IF_ERROR(OpenJoint());
    while (!open_.empty()) POISE_RETURN_IF_ERROR(ReadEntry());
    const std::string_view word = scanner_.NextWord();
    if (EqualsIgnoringCase(word, "ROOT")) {
      return scanner_.Error("a second ROOT; expected one body in a file, then 'MOTION'");
    }
    if (!EqualsIgnoringCase(word, "MOTION")) return scanner_.Expected("'MOTION'", word);
    if (hierarchy_.num_columns == 0) {
      return scanner_.Error("no joint has CHANNELS, expected at least one number in a frame");
    }
    return std::move(hierarchy_);
  }

 private:
  // A joint whose closing brace has not come yet.
  struct OpenJointState {
    int index;
    bool has_offset = false;
    bool has_channels = false;
  };

  Status OpenJoint() {
    if (hierarchy_.joints.size() >= Skeleton::kMaxJoints) {
      return base::InvalidArgument(
          "TOO_LARGE", "",
          fmt::format("{}: line {}: more than {} joints, the most that a skeleton may have",
                      scanner_.file(), scanner_.line_number(), Skeleton::kMaxJoints));
    }
    std::string name = ToUtf8(scanner_.RestOfLine('{'));
    if (name.empty()) return scanner_.Expected("a joint's name", "");
    if (!names_.insert(name).second) {
      return base::InvalidArgument(
          "DUPLICATE_JOINT", "",
          fmt::format("{}: line {}: a second joint is named {}, expected "
                      "each name once",
                      scanner_.file(), scanner_.line_number(), Quoted(name)));
    }
    POISE_RETURN_IF_ERROR(ExpectWord(scanner_, "{"));
    const int parent = open_.empty() ? -1 : open_.back().index;
    open_.push_back({static_cast<int>(hierarchy_.joints.size())});
    hierarchy_.joints.push_back({std::move(name), parent, Vec3::Zero(), std::nullopt});
    hierarchy_.channels.emplace_back();
    return absl::OkStatus();
  }

  Status ReadEntry() {
    const std::string_view word = scanner_.NextWord();
    if (EqualsIgnoringCase(word, "OFFSET")) {
      open_.back().has_offset = true;
      POISE_ASSIGN_OR_RETURN(hierarchy_.joints[open_.back().index].offset, ReadOffset(scanner_));
      return absl::OkStatus();
    }
    if (EqualsIgnoringCase(word, "CHANNELS")) return ReadChannels();
    if (EqualsIgnoringCase(word, "JOINT")) return OpenJoint();
    if (EqualsIgnoringCase(word, "End")) return ReadEndSite();
    if (word == "}") return CloseJoint();
    return scanner_.Expected("'OFFSET', 'CHANNELS', 'JOINT', 'End Site' or '}'", word);
  }

  Status ReadChannels() {
    const int index = open_.back().index;
    if (open_.back().has_channels) {
      return scanner_.Error(fmt::format("joint {} has CHANNELS twice, expected once",
                                        Quoted(hierarchy_.joints[index].name)));
    }
    open_.back().has_channels = true;
    POISE_ASSIGN_OR_RETURN(const int64_t count, scanner_.NextCount("CHANNELS", kMostChannels));
    for (int64_t i = 0; i < count; ++i) {
      const std::string_view word = scanner_.NextWord();
      const std::optional<BvhChannel> channel = ParseBvhChannel(word);
      if (!channel) {
        return scanner_.Expected(
            fmt::format("channel {} of {} like 'Xposition' or 'Zrotation'", i + 1, count), word);
      }
      for (const BvhChannel& earlier : hierarchy_.channels[index]) {
        if (channel->is_position && earlier == *channel) {
          return scanner_.Error(
              fmt::format("channel {} twice, expected once", BvhChannelName(*channel)));
        }
      }
      hierarchy_.channels[index].push_back(*channel);
    }
    hierarchy_.num_columns += static_cast<int>(count);
    return absl::OkStatus();
  }

  Status ReadEndSite() {
    POISE_RETURN_IF_ERROR(ExpectWord(scanner_, "Site"));
    scanner_.RestOfLine('{');  // some programs name their end sites
    POISE_RETURN_IF_ERROR(ExpectWord(scanner_, "{"));
    POISE_RETURN_IF_ERROR(ExpectWord(scanner_, "OFFSET"));
    POISE_ASSIGN_OR_RETURN(const Vec3 offset, ReadOffset(scanner_));
    POISE_RETURN_IF_ERROR(ExpectWord(scanner_, "}"));
    Joint& joint = hierarchy_.joints[open_.back().index];
    if (!joint.end_site) {
      joint.end_site = offset;
    } else {
      hierarchy_.notes.push_back(
          fmt::format("joint {}: only the first of its End Sites is kept", Quoted(joint.name)));
    }
    return absl::OkStatus();
  }

  Status CloseJoint() {
    if (!open_.back().has_offset) {
      return scanner_.Error(fmt::format("joint {} ends without an OFFSET, expected one",
                                        Quoted(hierarchy_.joints[open_.back().index].name)));
    }
    open_.pop_back();
    return absl::OkStatus();
  }

  TextScanner& scanner_;
  BvhHierarchy hierarchy_;
  std::vector<OpenJointState> open_;  // from the root to the joint that is being read
  std::unordered_set<std::string> names_;
};

}  // namespace

std::optional<BvhChannel> ParseBvhChannel(std::string_view name) {
  if (name.empty()) return std::nullopt;
  const int axis = (name.front() | 0x20) - 'x';
  if (axis < 0 || axis > 2) return std::nullopt;
  const std::string_view kind = name.substr(1);
  if (EqualsIgnoringCase(kind, "position")) return BvhChannel{true, axis};
  if (EqualsIgnoringCase(kind, "rotation")) return BvhChannel{false, axis};
  return std::nullopt;
}

std::string BvhChannelName(const BvhChannel& channel) {
  return fmt::format("{}{}", "XYZ"[channel.axis], channel.is_position ? "position" : "rotation");
}

StatusOr<BvhHierarchy> ReadBvhHierarchy(TextScanner& scanner) {
  return HierarchyReader(scanner).Read();
}

}  // namespace poise::motion
