#include "core/motion/io/asf_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <unordered_map>

#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

constexpr size_t kMostDofs = 7;  // three rotations, three translations, stretch

// "XYZ" in an ASF turns about X first: its product is Rz * Ry * Rx.
StatusOr<math::EulerOrder> ReadAxisOrder(TextScanner& scanner, std::string_view word) {
  auto order = math::ParseEulerOrder(std::string(word));
  if (!order.ok()) return scanner.Expected("an axis order like 'XYZ'", word);
  std::reverse(order->axes.begin(), order->axes.end());
  return *order;
}

// "rx", "TX", ...; `l` (stretch) is no joint's motion.
std::optional<AsfDof> ParseDof(std::string_view word) {
  if (word.size() != 2) return std::nullopt;
  const int axis = (word[1] | 0x20) - 'x';
  const char kind = static_cast<char>(word[0] | 0x20);
  if (axis < 0 || axis > 2 || (kind != 'r' && kind != 't')) return std::nullopt;
  return AsfDof{kind == 't', axis};
}

class AsfReader {
 public:
  AsfReader(std::string_view file, std::string_view data) : scanner_(file, "MALFORMED_ASF", data) {
    skeleton_.bones.emplace_back().name = "root";
    bone_of_name_["root"] = 0;
  }

  StatusOr<AsfSkeleton> Read() {
    std::string_view section;
    while (scanner_.NextLine()) {
      std::string_view word = scanner_.NextWordOfLine();
      if (word.starts_with('#')) continue;
      if (word.starts_with(':')) {
        section = word.substr(1);
        found_root_ |= EqualsIgnoringCase(section, "root");
        found_hierarchy_ |= EqualsIgnoringCase(section, "hierarchy");
        continue;
      }
      if (EqualsIgnoringCase(section, "units")) POISE_RETURN_IF_ERROR(ReadUnit(word));
      if (EqualsIgnoringCase(section, "root")) POISE_RETURN_IF_ERROR(ReadRootEntry(word));
      if (EqualsIgnoringCase(section, "bonedata")) POISE_RETURN_IF_ERROR(ReadBoneEntry(word));
      if (EqualsIgnoringCase(section, "hierarchy")) POISE_RETURN_IF_ERROR(ReadParent(word));
    }
    if (in_bone_) return scanner_.Expected("'end' of the bone", "");
    if (!found_root_) return scanner_.Expected("a section ':root'", "");
    if (!found_hierarchy_) return scanner_.Expected("a section ':hierarchy'", "");
    TurnAxes();
    return InOrder();
  }

 private:
  Status ReadUnit(std::string_view word) {
    if (EqualsIgnoringCase(word, "length")) {
      POISE_ASSIGN_OR_RETURN(skeleton_.length_unit, scanner_.NextNumber("length"));
      if (!(skeleton_.length_unit > 0)) {
        return scanner_.Error(
            fmt::format("length is {}, expected a positive number", skeleton_.length_unit));
      }
    } else if (EqualsIgnoringCase(word, "angle")) {
      const std::string_view unit = scanner_.NextWordOfLine();
      skeleton_.degrees = EqualsIgnoringCase(unit, "deg");
      if (!skeleton_.degrees && !EqualsIgnoringCase(unit, "rad")) {
        return scanner_.Expected("'deg' or 'rad'", unit);
      }
    }
    return absl::OkStatus();
  }

  Status ReadRootEntry(std::string_view word) {
    AsfBone& root = skeleton_.bones[0];
    if (EqualsIgnoringCase(word, "order")) return ReadDofs(root);
    if (EqualsIgnoringCase(word, "position")) {
      POISE_ASSIGN_OR_RETURN(skeleton_.root_position, ReadVector("position"));
    } else if (EqualsIgnoringCase(word, "orientation")) {
      POISE_ASSIGN_OR_RETURN(axis_angles_[0], ReadVector("orientation"));
    } else if (EqualsIgnoringCase(word, "axis")) {
      POISE_ASSIGN_OR_RETURN(root.rotation_order,
                             ReadAxisOrder(scanner_, scanner_.NextWordOfLine()));
    }
    return absl::OkStatus();
  }

  Status ReadBoneEntry(std::string_view word) {
    if (EqualsIgnoringCase(word, "begin")) return BeginBone();
    if (!in_bone_) return scanner_.Expected("'begin' of a bone", word);
    AsfBone& bone = skeleton_.bones.back();
    if (EqualsIgnoringCase(word, "end")) return EndBone();
    if (EqualsIgnoringCase(word, "name")) return NameBone(bone);
    if (EqualsIgnoringCase(word, "direction")) {
      POISE_ASSIGN_OR_RETURN(bone.direction, ReadVector("direction"));
    } else if (EqualsIgnoringCase(word, "length")) {
      POISE_ASSIGN_OR_RETURN(bone.length, scanner_.NextNumber("length"));
    } else if (EqualsIgnoringCase(word, "axis")) {
      POISE_ASSIGN_OR_RETURN(axis_angles_.back(), ReadVector("axis"));
      POISE_ASSIGN_OR_RETURN(bone.rotation_order,
                             ReadAxisOrder(scanner_, scanner_.NextWordOfLine()));
    } else if (EqualsIgnoringCase(word, "dof")) {
      return ReadDofs(bone);
    }
    return absl::OkStatus();  // id, limits, bodymass and the like say nothing about the motion
  }

  Status BeginBone() {
    if (in_bone_) return scanner_.Expected("'end' of the bone before the next 'begin'", "begin");
    if (skeleton_.bones.size() >= Skeleton::kMaxJoints) {
      return base::InvalidArgument(
          "TOO_LARGE", "",
          fmt::format("{}: line {}: more than {} bones, the most that a skeleton may have",
                      scanner_.file(), scanner_.line_number(), Skeleton::kMaxJoints));
    }
    in_bone_ = true;
    skeleton_.bones.emplace_back().line = scanner_.line_number();
    axis_angles_.push_back(Vec3::Zero());
    return absl::OkStatus();
  }

  Status EndBone() {
    if (skeleton_.bones.back().name.empty()) {
      return scanner_.Error("a bone ends without a name, expected 'name ...'");
    }
    in_bone_ = false;
    return absl::OkStatus();
  }

  Status NameBone(AsfBone& bone) {
    const std::string_view name = scanner_.NextWordOfLine();
    if (name.empty()) return scanner_.Expected("a bone's name", "");
    bone.name = ToUtf8(name);
    const int index = static_cast<int>(skeleton_.bones.size()) - 1;
    if (!bone_of_name_.emplace(bone.name, index).second) {
      return base::InvalidArgument(
          "DUPLICATE_JOINT", "",
          fmt::format("{}: line {}: a second bone is named {}, expected each name once",
                      scanner_.file(), scanner_.line_number(), Quoted(bone.name)));
    }
    return absl::OkStatus();
  }

  Status ReadDofs(AsfBone& bone) {
    bone.dofs.clear();
    for (std::string_view word; !(word = scanner_.NextWordOfLine()).empty();) {
      const auto dof = ParseDof(word);
      if (!dof || bone.dofs.size() >= kMostDofs) {
        return scanner_.Expected("at most 7 degrees of freedom like 'rx' or 'tz'", word);
      }
      bone.dofs.push_back(*dof);
    }
    return absl::OkStatus();
  }

  StatusOr<Vec3> ReadVector(std::string_view what) {
    Vec3 vector;
    for (int axis = 0; axis < 3; ++axis) {
      POISE_ASSIGN_OR_RETURN(vector[axis],
                             scanner_.NextNumber(fmt::format("{} {}", what, "xyz"[axis])));
    }
    return vector;
  }

  // "thorax lowerneck lclavicle rclavicle": a bone and those that begin at its end.
  Status ReadParent(std::string_view word) {
    if (EqualsIgnoringCase(word, "begin") || EqualsIgnoringCase(word, "end")) {
      return absl::OkStatus();
    }
    POISE_ASSIGN_OR_RETURN(const int parent, FindBone(word));
    for (std::string_view child; !(child = scanner_.NextWordOfLine()).empty();) {
      POISE_ASSIGN_OR_RETURN(const int bone, FindBone(child));
      if (bone == 0) return scanner_.Error("'root' hangs on a bone, expected it above all others");
      if (skeleton_.bones[bone].parent >= 0) {
        return scanner_.Error(fmt::format("bone {} has a second parent {}, expected one",
                                          Quoted(child), Quoted(word)));
      }
      skeleton_.bones[bone].parent = parent;
    }
    return absl::OkStatus();
  }

  StatusOr<int> FindBone(std::string_view name) {
    const auto found = bone_of_name_.find(ToUtf8(name));
    if (found == bone_of_name_.end()) {
      return scanner_.Expected("the name of a bone in ':bonedata'", name);
    }
    return found->second;
  }

  // The unit of angles may stand behind the bones.
  void TurnAxes() {
    const double radians = skeleton_.degrees ? std::numbers::pi / 180 : 1;
    for (size_t i = 0; i < skeleton_.bones.size(); ++i) {
      AsfBone& bone = skeleton_.bones[i];
      const auto& axes = bone.rotation_order.axes;
      const Vec3& xyz = axis_angles_[i];
      bone.axis = math::FromEuler(radians * Vec3(xyz[axes[0]], xyz[axes[1]], xyz[axes[2]]),
                                  bone.rotation_order);
    }
  }

  // Parents first. What cannot be reached from the root has no parent or is its own ancestor.
  StatusOr<AsfSkeleton> InOrder() {
    std::vector<std::vector<int>> children(skeleton_.bones.size());
    for (size_t i = 1; i < skeleton_.bones.size(); ++i) {
      const AsfBone& bone = skeleton_.bones[i];
      if (bone.parent < 0) return Unreachable(bone, "has no parent");
      children[bone.parent].push_back(static_cast<int>(i));
    }
    std::vector<int> new_index(skeleton_.bones.size(), -1);
    AsfSkeleton ordered = skeleton_;
    ordered.bones.clear();
    std::vector<int> waiting = {0};
    while (!waiting.empty()) {
      const int bone = waiting.back();
      waiting.pop_back();
      new_index[bone] = static_cast<int>(ordered.bones.size());
      ordered.bones.push_back(skeleton_.bones[bone]);
      if (bone > 0) ordered.bones.back().parent = new_index[skeleton_.bones[bone].parent];
      waiting.insert(waiting.end(), children[bone].rbegin(), children[bone].rend());
    }
    for (size_t i = 0; i < new_index.size(); ++i) {
      if (new_index[i] < 0) return Unreachable(skeleton_.bones[i], "is its own ancestor");
    }
    return ordered;
  }

  Status Unreachable(const AsfBone& bone, std::string_view problem) const {
    return base::InvalidArgument(
        "MALFORMED_ASF", "",
        fmt::format("{}: line {}: bone {} {} in ':hierarchy', expected a way to 'root'",
                    scanner_.file(), bone.line, Quoted(bone.name), problem));
  }

  TextScanner scanner_;
  AsfSkeleton skeleton_;
  std::vector<Vec3> axis_angles_ = {Vec3::Zero()};  // (bones) x, y, z as written
  std::unordered_map<std::string, int> bone_of_name_;
  bool in_bone_ = false, found_root_ = false, found_hierarchy_ = false;
};

}  // namespace

std::vector<Joint> AsfSkeleton::Joints() const {
  std::vector<Joint> joints;
  for (const AsfBone& bone : bones) {
    joints.push_back({bone.name, bone.parent, Vec3::Zero(), bone.direction * bone.length});
    if (bone.parent < 0) continue;
    joints.back().offset = bones[bone.parent].direction * bones[bone.parent].length;
    joints[bone.parent].end_site.reset();
  }
  if (joints.size() == 1) joints[0].end_site.reset();
  return joints;
}

StatusOr<AsfSkeleton> ReadAsf(std::string_view file, std::string_view data) {
  return AsfReader(file, data).Read();
}

}  // namespace poise::motion
