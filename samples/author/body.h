#ifndef POISE_SAMPLES_AUTHOR_BODY_H_
#define POISE_SAMPLES_AUTHOR_BODY_H_

#include "core/motion/skeleton.h"

/// The performer of the bundled samples: an invented adult of 1.75 m with ordinary proportions.
namespace poise::samples {

using math::Quat;
using math::Vec3;

enum class Side { kLeft, kRight };

inline constexpr Side kSides[] = {Side::kLeft, Side::kRight};

/// +1 on the left (the body faces +Z, so left is +X), -1 on the right: turns "outward" into X.
constexpr double Outward(Side side) { return side == Side::kLeft ? 1.0 : -1.0; }

inline constexpr double kThigh = 0.425;     ///< [m] hip to knee
inline constexpr double kShank = 0.415;     ///< [m] knee to ankle
inline constexpr double kUpperArm = 0.285;  ///< [m] shoulder to elbow
inline constexpr double kForearm = 0.250;   ///< [m] elbow to wrist

/// The foot in its own frame: origin at the ankle, sole flat, toes along +Z.
inline const Vec3 kBallFromAnkle(0, -0.062, 0.130);  ///< [m] the toe joint
inline constexpr double kAnkleHeight = 0.082;        ///< [m] above the sole
inline constexpr double kHeelBehindAnkle = 0.050;    ///< [m] back edge of the sole
inline constexpr double kToeLength = 0.062;          ///< [m] ball to tip

/// Indices of the trunk's joints: legs come before it, arms after it, as in the file.
inline constexpr int kHips = 0;
inline constexpr int kSpine = 9;
inline constexpr int kChest = 10;
inline constexpr int kNeck = 11;
inline constexpr int kHead = 12;
inline constexpr int kNumJoints = 21;

/// Indices of the joints of one side.
struct LegJoints {
  int hip, knee, ankle, toe;
};
struct ArmJoints {
  int collar, shoulder, elbow, wrist;
};
LegJoints Leg(Side side);
ArmJoints Arm(Side side);

/// The skeleton in a T-pose facing +Z, left at +X, Y up; joints named as in the BVH conversion of
/// the CMU data (Hips, Spine, Spine1, LeftUpLeg, ...); hands, toes and head end in end sites.
/// Knees flex about +X of their parent, elbows about -Y (left) or +Y (right).
motion::SkeletonPtr MakeBody();

}  // namespace poise::samples

#endif  // POISE_SAMPLES_AUTHOR_BODY_H_
