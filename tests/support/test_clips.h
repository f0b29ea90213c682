#ifndef POISE_TESTS_SUPPORT_TEST_CLIPS_H_
#define POISE_TESTS_SUPPORT_TEST_CLIPS_H_

#include <cstdint>

#include "core/motion/clip.h"

/// Small bodies and motions that tests make themselves.
namespace poise::testing {

/// An upright biped of 1.7 m in a T-pose facing +Z, 21 joints named by their roles
/// ("left_hip", ...), with end sites at head, hands and toes. Ankles at 0.08 m above the floor.
motion::SkeletonPtr Biped();

/// A smooth motion of Biped(): every joint swings on its own axis with its own phase, the root
/// travels. All rotations below `amplitude` radians.
motion::Clip SwingingClip(int frames, double frame_rate = 120, double amplitude = 0.3,
                          uint64_t seed = 1);

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_TEST_CLIPS_H_
