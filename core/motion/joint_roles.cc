#include "core/motion/joint_roles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "absl/strings/ascii.h"
#include "core/base/config_fields.h"
#include "core/base/json.h"

namespace poise::motion {
namespace {

constexpr std::array<const char*, kNumRoles> kRoleNames = {
    "pelvis",      "spine",          "chest",       "neck",        "right_hip", "right_knee",
    "right_ankle", "right_shoulder", "right_elbow", "right_wrist", "left_hip",  "left_knee",
    "left_ankle",  "left_shoulder",  "left_elbow",  "left_wrist",  "head",      "right_toe",
    "left_toe",    "right_collar",   "left_collar"};

// One naming scheme: the joint name of each role in the order of JointRole, "" where it has none.
// A family is recognised by how many of its names a skeleton has.
struct NamingScheme {
  const char* name;
  std::array<const char*, kNumRoles> joints;
};

constexpr NamingScheme kSchemes[] = {
    {"roles", kRoleNames},
    // Before CMU, whose names these two contain: the arms hang off Spine2 here.
    {"mixamo",
     {"hips",        "spine",         "spine2",       "neck",      "rightupleg", "rightleg",
      "rightfoot",   "rightarm",      "rightforearm", "righthand", "leftupleg",  "leftleg",
      "leftfoot",    "leftarm",       "leftforearm",  "lefthand",  "head",       "righttoebase",
      "lefttoebase", "rightshoulder", "leftshoulder"}},
    {"lafan", {"hips",      "spine",         "spine2",       "neck",      "rightupleg", "rightleg",
               "rightfoot", "rightarm",      "rightforearm", "righthand", "leftupleg",  "leftleg",
               "leftfoot",  "leftarm",       "leftforearm",  "lefthand",  "head",       "righttoe",
               "lefttoe",   "rightshoulder", "leftshoulder"}},
    // CMU's BVH conversion; Hips, Spine, Spine1, Neck are the joints that MotionAug keeps.
    {"cmu",
     {"hips",        "spine",         "spine1",       "neck",      "rightupleg", "rightleg",
      "rightfoot",   "rightarm",      "rightforearm", "righthand", "leftupleg",  "leftleg",
      "leftfoot",    "leftarm",       "leftforearm",  "lefthand",  "head",       "righttoebase",
      "lefttoebase", "rightshoulder", "leftshoulder"}},
    // ASF bone names of HDM05 and CMU. A bone's joint is where the bone begins, so the hand hangs
    // off `lwrist` (the BVH conversion calls the same joint LeftHand).
    {"asf", {"root",     "upperback", "thorax", "lowerneck", "rfemur", "rtibia",    "rfoot",
             "rhumerus", "rradius",   "rwrist", "lfemur",    "ltibia", "lfoot",     "lhumerus",
             "lradius",  "lwrist",    "head",   "rtoes",     "ltoes",  "rclavicle", "lclavicle"}},
    {"bandai", {"hips",   "spine",      "chest",      "neck",   "upperleg_r", "lowerleg_r",
                "foot_r", "upperarm_r", "lowerarm_r", "hand_r", "upperleg_l", "lowerleg_l",
                "foot_l", "upperarm_l", "lowerarm_l", "hand_l", "head",       "toes_r",
                "toes_l", "shoulder_r", "shoulder_l"}},
    {"smpl",
     {"pelvis",      "spine1",         "spine3",      "neck",        "right_hip", "right_knee",
      "right_ankle", "right_shoulder", "right_elbow", "right_wrist", "left_hip",  "left_knee",
      "left_ankle",  "left_shoulder",  "left_elbow",  "left_wrist",  "head",      "right_foot",
      "left_foot",   "right_collar",   "left_collar"}},
    {"fzj", {"joint_0",  "joint_1",  "joint_3", "joint_4",  "joint_14", "joint_15", "joint_16",
             "joint_7",  "joint_8",  "joint_9", "joint_18", "joint_19", "joint_20", "joint_11",
             "joint_12", "joint_13", "joint_5", "joint_17", "joint_21", "joint_6",  "joint_10"}},
};

// "mixamorig:LeftUpLeg" and "LeftUpLeg" are one name.
std::string Canonical(std::string_view name) {
  const size_t colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  return absl::AsciiStrToLower(std::string(name));
}

std::array<int, kNumRoles> Match(const NamingScheme& scheme, std::span<const std::string> names) {
  std::array<int, kNumRoles> joints;
  joints.fill(-1);
  for (int role = 0; role < kNumRoles; ++role) {
    const auto found = std::find(names.begin(), names.end(), scheme.joints[role]);
    if (found != names.end()) joints[role] = static_cast<int>(found - names.begin());
  }
  return joints;
}

}  // namespace

const char* RoleName(JointRole role) { return kRoleNames[static_cast<int>(role)]; }

std::optional<JointRole> ParseRole(std::string_view name) {
  for (int role = 0; role < kNumRoles; ++role) {
    if (name == kRoleNames[role]) return static_cast<JointRole>(role);
  }
  return std::nullopt;
}

JointRole MirrorRole(JointRole role) {
  const std::string name = RoleName(role);
  if (name.starts_with("left_")) return *ParseRole(fmt::format("right_{}", name.substr(5)));
  if (name.starts_with("right_")) return *ParseRole(fmt::format("left_{}", name.substr(6)));
  return role;
}

StatusOr<JointRoles> JointRoles::Detect(const Skeleton& skeleton, const RoleOverrides& overrides) {
  JointRoles roles;
  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints()) {
    names.push_back(Canonical(joint.name));
    roles.joint_names_.push_back(joint.name);
  }
  const auto count = [](const std::array<int, kNumRoles>& joints) {
    return std::count_if(joints.begin(), joints.end(), [](int joint) { return joint >= 0; });
  };
  roles.joints_.fill(-1);
  for (const NamingScheme& scheme : kSchemes) {
    const auto match = Match(scheme, names);
    if (count(match) > count(roles.joints_)) roles.joints_ = match;
  }
  for (const auto& [role_name, joint_name] : overrides) {
    const auto role = ParseRole(role_name);
    const auto joint = skeleton.Find(joint_name);
    if (!role) {
      return base::InvalidArgument("UNKNOWN_ROLE", fmt::format("joint_roles.{}", role_name),
                                   fmt::format("unknown joint role '{}'; roles: {}", role_name,
                                               fmt::join(kRoleNames, ", ")));
    }
    if (!joint) {
      const std::string nearest = base::NearestName(joint_name, roles.joint_names_);
      return base::InvalidArgument(
          "UNKNOWN_JOINT", fmt::format("joint_roles.{}", role_name),
          fmt::format("role '{}' is mapped to '{}', which the skeleton does not have{}", role_name,
                      joint_name,
                      nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
    }
    roles.joints_[static_cast<int>(*role)] = *joint;
  }
  return roles;
}

StatusOr<RoleOverrides> JointRoles::ParseOverrides(std::string_view text) {
  POISE_ASSIGN_OR_RETURN(const base::Json json, base::ParseJson(text, "joint role map"));
  if (!json.is_object()) {
    return base::InvalidArgument("MALFORMED_ROLE_MAP", "",
                                 "joint role map: expected an object {\"left_hip\": \"...\"}");
  }
  RoleOverrides overrides;
  for (const auto& [role, joint] : json.items()) {
    if (!ParseRole(role)) {
      return base::InvalidArgument("UNKNOWN_ROLE", role,
                                   fmt::format("joint role map: unknown role '{}'; roles: {}", role,
                                               fmt::join(kRoleNames, ", ")));
    }
    if (!joint.is_string()) {
      return base::InvalidArgument("MALFORMED_ROLE_MAP", role,
                                   fmt::format("joint role map: '{}' must name a joint", role));
    }
    overrides[role] = joint.get<std::string>();
  }
  return overrides;
}

std::optional<JointRole> JointRoles::role(int joint) const {
  for (int role = 0; role < kNumRoles; ++role) {
    if (joints_[role] == joint) return static_cast<JointRole>(role);
  }
  return std::nullopt;
}

std::vector<std::string> JointRoles::missing() const {
  std::vector<std::string> names;
  for (int role = 0; role < kNumRequiredRoles; ++role) {
    if (joints_[role] < 0) names.push_back(kRoleNames[role]);
  }
  return names;
}

namespace {

Status MissingRoles(const std::vector<std::string>& missing,
                    const std::vector<std::string>& joints) {
  return base::FailedPrecondition(
      "MISSING_ROLES", "joint_roles",
      fmt::format("no joint found for {}; map them by hand (poise --roles FILE, or joint_roles in "
                  "a request: {{\"left_hip\": \"NameOfJoint\", ...}}); joints here: {}",
                  fmt::join(missing, ", "), fmt::join(joints, " ")));
}

}  // namespace

Status JointRoles::RequireComplete() const {
  const std::vector<std::string> names = missing();
  return names.empty() ? absl::OkStatus() : MissingRoles(names, joint_names_);
}

Status JointRoles::Require(std::initializer_list<JointRole> roles) const {
  std::vector<std::string> names;
  for (const JointRole role : roles) {
    if (!has(role)) names.push_back(RoleName(role));
  }
  return names.empty() ? absl::OkStatus() : MissingRoles(names, joint_names_);
}

}  // namespace poise::motion
