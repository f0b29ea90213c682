#ifndef POISE_TESTS_CORE_CORRECTION_TRACKED_CLIP_H_
#define POISE_TESTS_CORE_CORRECTION_TRACKED_CLIP_H_

#include <filesystem>

#include "core/correction/reference_motion.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

/// A motion and the character that is to imitate it.
struct TrackedClip {
  physics::HumanoidModelPtr model;
  ReferenceMotion reference;
};

TrackedClip Prepare(const motion::Clip& clip, const ReferenceConfig& config = {});
TrackedClip ReadAndPrepare(const std::filesystem::path& file, const ReferenceConfig& config = {});

/// The test skeleton stands for `seconds` and, from the first second on, sways its arms.
motion::Clip SwayingClip(double seconds);

}  // namespace poise::correction

#endif  // POISE_TESTS_CORE_CORRECTION_TRACKED_CLIP_H_
