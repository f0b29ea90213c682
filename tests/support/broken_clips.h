#ifndef POISE_TESTS_SUPPORT_BROKEN_CLIPS_H_
#define POISE_TESTS_SUPPORT_BROKEN_CLIPS_H_

#include <array>
#include <string_view>

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

/// Sound clips, broken on purpose: what the correction of motion is for.
namespace poise::testing {

enum class Fault {
  kCrossedLegs,  ///< both thighs turned inwards by 14 degrees: the legs run through each other
  kSunk,         ///< the body 5 cm too low
  kSlidingFeet,  ///< the whole body glides in circles of 12 cm radius, at 0.3 m/s
  kFloating,     ///< the body 5 cm too high
};
inline constexpr std::array kFaults = {Fault::kCrossedLegs, Fault::kSunk, Fault::kSlidingFeet,
                                       Fault::kFloating};

std::string_view FaultName(Fault fault);

/// The fault covers the middle 70 % of the clip, coming and going smoothly; the glide all of it.
motion::Clip Break(motion::Clip clip, const motion::JointRoles& roles, Fault fault);

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_BROKEN_CLIPS_H_
