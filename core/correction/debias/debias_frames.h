#ifndef POISE_CORE_CORRECTION_DEBIAS_DEBIAS_FRAMES_H_
#define POISE_CORE_CORRECTION_DEBIAS_DEBIAS_FRAMES_H_

#include <Eigen/Core>

#include "core/correction/debias/debias_config.h"
#include "core/motion/clip.h"

/// Between motions of the character's 16 joints and the numbers of the debiasing network: all are
/// relative to where the body stands and faces, so that neither changes what is undone.
namespace poise::correction {

/// Rows are frames.
using FrameRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Columns of a correction: root 3 [m, in heading axes], 16 joints' 6D rotations less the imitated
/// ones (the root's from the heading). So where a joint really was can be said whatever the
/// imitation did with it: its own rotation is among the inputs.
inline constexpr int kCorrectionWidth = 3 + 6 * 16;

/// Standardised inputs beyond this are cut off: a pose unlike all that were learned from.
inline constexpr float kInputLimit = 5;

/// Columns of MakeFrameRows.
int InputWidth(const DebiasInput& input);

/// What the network sees of each frame: height [m] and tilt of the root, the joints' rotations
/// (6D), and for each of DebiasInput's moments before and after the way there: the root's in
/// heading axes [m], every joint's as a rotation vector from here to there. Moments outside the
/// motion are its first or last frame. Precondition: `clip` has 16 joints.
FrameRows MakeFrameRows(const motion::Clip& clip, const DebiasInput& input);

/// The correction that turns each frame of `imitated` into that of `original`. Shape: (frames,
/// kCorrectionWidth). Precondition: the same frames, 16 joints each.
FrameRows CorrectionBetween(const motion::Clip& imitated, const motion::Clip& original);

/// p + heading * correction; the rotations nearest to the corrected columns (Gram-Schmidt). What is
/// corrected by zeros keeps every bit, and a joint whose columns would vanish stays as it is.
motion::Clip ApplyCorrection(motion::Clip imitated, const FrameRows& correction);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_DEBIAS_FRAMES_H_
