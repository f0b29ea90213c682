#ifndef POISE_TESTS_FUZZ_FUZZ_CLIP_H_
#define POISE_TESTS_FUZZ_FUZZ_CLIP_H_

#include <cmath>
#include <cstdlib>

#include "core/motion/io/clip_file.h"

/// What must hold for any input of any format.
namespace poise::fuzz {

/// A clip that was read can be written as BVH, and what was written can be read: stops the program
/// where that fails. Numbers so large that no file keeps them are left out.
inline void CheckClip(const StatusOr<motion::ClipFile>& file) {
  if (!file.ok()) return;
  const motion::Clip& clip = file->clip;
  double largest = 0;
  for (const motion::Vec3& position : clip.root_positions()) {
    largest = std::fmax(largest, position.cwiseAbs().maxCoeff());
  }
  for (const motion::Joint& joint : clip.skeleton()->joints()) {
    largest = std::fmax(largest, joint.offset.cwiseAbs().maxCoeff());
    if (joint.end_site) largest = std::fmax(largest, joint.end_site->cwiseAbs().maxCoeff());
  }
  if (!(largest < 1e6)) return;
  const std::string text = motion::EncodeBvh(clip, file->convention);
  motion::ClipHints hints;
  hints.unit_m = file->convention.unit_m;
  hints.up = file->convention.up;
  const auto again = motion::DecodeClip("again.bvh", text, motion::ClipFormat::kBvh, hints);
  if (!again.ok() || again->clip.num_frames() != clip.num_frames()) std::abort();
}

}  // namespace poise::fuzz

#endif  // POISE_TESTS_FUZZ_FUZZ_CLIP_H_
