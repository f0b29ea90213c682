#ifndef POISE_CORE_MOTION_JOINT_ROLES_H_
#define POISE_CORE_MOTION_JOINT_ROLES_H_

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/motion/skeleton.h"

namespace poise::motion {

/// What a joint is on a biped, whatever its file calls it. A role names the joint that turns the
/// bone below it: kLeftHip turns the left thigh, kLeftWrist the left hand.
/// The first 16 are MotionAug's joints in its order (reference sec. 1.6) and are required; the rest
/// are used where a skeleton has them.
enum class JointRole {
  kPelvis,
  kSpine,
  kChest,
  kNeck,
  kRightHip,
  kRightKnee,
  kRightAnkle,
  kRightShoulder,
  kRightElbow,
  kRightWrist,
  kLeftHip,
  kLeftKnee,
  kLeftAnkle,
  kLeftShoulder,
  kLeftElbow,
  kLeftWrist,
  kHead,
  kRightToe,
  kLeftToe,
  kRightCollar,
  kLeftCollar,
};

inline constexpr int kNumRequiredRoles = 16;
inline constexpr int kNumRoles = 21;

/// "left_hip" and so on: the name in JSON, mapping files and flags.
const char* RoleName(JointRole role);
std::optional<JointRole> ParseRole(std::string_view name);
/// The same role on the other side; roles of the trunk are their own mirror.
JointRole MirrorRole(JointRole role);

/// Which joint plays which role, by hand: role name -> joint name.
using RoleOverrides = std::map<std::string, std::string>;

/// The roles of one skeleton.
class JointRoles {
 public:
  /// Recognises HDM05/CMU (ASF bone names and the BVH conversion), Mixamo, LAFAN, Bandai-Namco,
  /// SMPL, FZJ (`joint_N`) and Poise's own role names, with any prefix up to a colon and in any
  /// case; `overrides` win. Missing roles are no error here.
  /// Errors: kInvalidArgument: UNKNOWN_ROLE, UNKNOWN_JOINT (of an override).
  static StatusOr<JointRoles> Detect(const Skeleton& skeleton, const RoleOverrides& overrides = {});

  /// Reads a mapping file: a JSON object {"left_hip": "LeftUpLeg", ...}.
  /// Errors: MALFORMED_JSON, MALFORMED_ROLE_MAP, UNKNOWN_ROLE.
  static StatusOr<RoleOverrides> ParseOverrides(std::string_view json);

  /// Joint index, or -1.
  int joint(JointRole role) const { return joints_[static_cast<int>(role)]; }
  bool has(JointRole role) const { return joint(role) >= 0; }
  /// Role of a joint, if it has one.
  std::optional<JointRole> role(int joint) const;

  /// Names of required roles that no joint plays.
  std::vector<std::string> missing() const;
  /// Errors: kFailedPrecondition MISSING_ROLES, listing them and how to map them by hand.
  Status RequireComplete() const;
  /// Errors: as RequireComplete, for these roles only.
  Status Require(std::initializer_list<JointRole> roles) const;

 private:
  std::array<int, kNumRoles> joints_{};
  std::vector<std::string> joint_names_;  // of the skeleton, for messages
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_JOINT_ROLES_H_
