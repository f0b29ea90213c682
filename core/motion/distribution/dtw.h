#ifndef POISE_CORE_MOTION_DISTRIBUTION_DTW_H_
#define POISE_CORE_MOTION_DISTRIBUTION_DTW_H_

#include <Eigen/Core>
#include <limits>
#include <span>

/// How far two motions are apart when time may be stretched: exact dynamic time warping. (The
/// authors of MotionAug approximate it with FastDTW; reference sec. 2.10.)
namespace poise::motion {

/// Rows: frames of one motion, at least one; columns: what a frame is described by.
using FrameFeatures = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Euclidean distances of the frames that are laid upon each other, added up along the cheapest
/// way from both first to both last frames, over the number of frames of the longer motion. A way
/// goes on in one motion or in both. Infinity as soon as it is certain to be above `limit`.
/// Precondition: equal columns.
double DtwDistance(const FrameFeatures& a, const FrameFeatures& b,
                   double limit = std::numeric_limits<double>::infinity());

struct NearestMotion {
  int index = -1;  ///< -1 of an empty set
  double distance = std::numeric_limits<double>::infinity();
};

/// The nearest of a set; the motion at `left_out` does not count.
NearestMotion FindNearest(const FrameFeatures& motion, std::span<const FrameFeatures> set,
                          int left_out = -1);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DISTRIBUTION_DTW_H_
