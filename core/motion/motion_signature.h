#ifndef POISE_CORE_MOTION_MOTION_SIGNATURE_H_
#define POISE_CORE_MOTION_MOTION_SIGNATURE_H_

#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"
#include "core/motion/pose_codec.h"

namespace poise::motion {

/// What a model's numbers mean: which joints, as which numbers, at which rate. Bone lengths are no
/// part of it: another body's motion is brought in by roles (editing/retarget.h).
struct MotionSignature {
  std::vector<JointRole> roles;  ///< the joints, in the order of the columns
  RotationRepresentation rotation = RotationRepresentation::kSixD;
  bool with_root_position = true;  ///< three columns before the joints' [m]
  double frame_rate = 30;          ///< [Hz]

  /// Columns of a frame.
  int width() const;
  bool operator==(const MotionSignature&) const = default;
};

/// The 16 required roles in their order.
std::vector<JointRole> RequiredRoles();

/// "quaternion", "matrix", "six_d", "exponential_map", "euler"
const char* RotationRepresentationName(RotationRepresentation representation);

/// {"roles": ["pelvis", ...], "rotation": "six_d", "root_position": true, "frame_rate": 30}
base::Json ToJson(const MotionSignature& signature);
/// Errors: kInvalidArgument MALFORMED_SIGNATURE, UNKNOWN_ROLE.
StatusOr<MotionSignature> SignatureFromJson(const base::Json& json);

/// What two signatures disagree in, one phrase each: "rate 30 Hz, not 120 Hz". Empty when they are
/// the same.
std::vector<std::string> Differences(const MotionSignature& expected,
                                     const MotionSignature& actual);

/// Whether a model of this signature can take the clip as it is.
/// Errors: kFailedPrecondition SIGNATURE_MISMATCH, listing every difference (roles that no joint
/// plays, the rate) and what would remove it; `model` is for the message.
Status CheckFits(const MotionSignature& signature, const std::string& model, const Clip& clip,
                 const JointRoles& roles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_MOTION_SIGNATURE_H_
