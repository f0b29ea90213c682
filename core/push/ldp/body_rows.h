#ifndef POISE_CORE_PUSH_LDP_BODY_ROWS_H_
#define POISE_CORE_PUSH_LDP_BODY_ROWS_H_

#include <torch/torch.h>

#include <span>
#include <string>
#include <vector>

#include "core/push/takes/push_take.h"
#include "core/push/training/pose_training.h"

/// Recorded bodies as the pose models see them: rows of features, frame by frame (reference
/// sec. 6). Positions [mm] count from the hip of frame 0, heights from the floor.
namespace poise::push::ldp {

/// The joints that one CVAE makes, in their order: "low_up" gives legs and trunk, "full" one part.
std::vector<std::vector<int>> BodyParts(const std::string& parts);

/// Displacement (2), facing, positions, velocities and 6-D rotations of `joints` joints.
constexpr int64_t FeatureCount(size_t joints) { return 3 + 12 * static_cast<int64_t>(joints); }

/// x, y, theta, phi, rod end (3), rod, and the changes of all but the rod to the next frame.
inline constexpr int64_t kPendulumFeatures = 15;

/// Shape: (..., frames - 1, kPendulumFeatures) of `position` (..., frames, 4), relative to
/// `origin` (..., 2), the hip of frame 0; `rod` and `cart_height` (...) are those of frame 0.
torch::Tensor PendulumFeatures(const torch::Tensor& position, const torch::Tensor& rod,
                               const torch::Tensor& cart_height, const torch::Tensor& origin);

/// Sequences of several people behind each other: from the frame in which each begins to move.
struct BodyRows {
  std::vector<torch::Tensor> parts;  ///< (rows, FeatureCount) each
  torch::Tensor pendulum;            ///< (rows, kPendulumFeatures) recorded
  std::vector<int64_t> first_rows;   ///< of each sequence, and the number of rows at the end

  /// Rows after which `rollout` more are in the same sequence, every `stride`th.
  std::vector<int64_t> Starts(int64_t rollout, int64_t stride = 1) const;
};
BodyRows MakeBodyRows(const std::vector<PersonRef>& people,
                      const std::vector<std::vector<int>>& parts);

/// The features of frame 0 of one person, who stands still: (1, FeatureCount) each part.
std::vector<torch::Tensor> FirstFeatures(const TakePerson& person,
                                         const std::vector<std::vector<int>>& parts);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_BODY_ROWS_H_
