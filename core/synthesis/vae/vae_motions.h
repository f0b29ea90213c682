#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_MOTIONS_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_MOTIONS_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/dataset/fold.h"
#include "core/motion/dataset/labelled_clip.h"
#include "core/motion/pose_codec.h"

namespace poise::synthesis {

/// How the root's position becomes three columns: (position - mean) / scale.
struct RootScale {
  motion::Vec3 mean = motion::Vec3::Zero();
  motion::Vec3 scale = motion::Vec3::Ones();

  /// {"mean": [x, y, z], "scale": [x, y, z]}
  base::Json ToJson() const;
  /// Errors: kInvalidArgument MALFORMED_CARD.
  static StatusOr<RootScale> FromJson(const base::Json& json);
};

/// A clip as the VAE learns it: on the 16 joints of the required roles, standing where it begins
/// and facing +Z (editing/align.h), at `frame_rate`.
/// Rows of each matrix: frames; columns: root position [m], 6D rotations. A clip of a whole
/// multiple of the rate is thinned out, once from each of its first frames on (reference sec. 1.5);
/// another one is resampled.
struct PreparedMotion {
  std::vector<motion::PoseMatrix> phases;
  motion::SkeletonPtr skeleton;  ///< reduced
};

/// Errors: those of JointRoles, Align and ReduceToRoles, with the clip's name.
StatusOr<PreparedMotion> PrepareMotion(const motion::Clip& clip, double frame_rate);

/// The motions of a fold, ready to learn.
struct Fold {
  std::vector<PreparedMotion> train;
  std::vector<PreparedMotion> held_out;
  std::string description;  ///< "class kick, actors bd bk dg mm, tr held out"
};

/// Errors: those of motion::ChooseFold and PrepareMotion.
StatusOr<Fold> PrepareFold(const std::vector<motion::LabelledClip>& clips,
                           const motion::FoldChoice& choice, double frame_rate);

/// `unit`: as VaeConfig::root_unit.
RootScale MakeRootScale(std::string_view unit, const std::vector<PreparedMotion>& motions);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_MOTIONS_H_
