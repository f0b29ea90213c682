#ifndef POISE_CORE_MOTION_SKELETON_H_
#define POISE_CORE_MOTION_SKELETON_H_

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/math/rotation.h"

namespace poise::motion {

using math::Quat;
using math::Vec3;

/// One joint: where it sits on its parent when nothing is rotated, and what hangs off it.
struct Joint {
  std::string name;
  int parent = -1;               ///< index of an earlier joint; -1 only for joint 0, the root
  Vec3 offset = Vec3::Zero();    ///< [m] in the parent's frame
  std::optional<Vec3> end_site;  ///< [m] tip of a bone that no joint ends, in this joint's frame
};

/// The tree of joints that a clip's numbers refer to. Constant and shared.
/// Joints are stored parents first, the root at index 0.
class Skeleton {
 public:
  static constexpr int kMaxJoints = 1024;

  /// Errors: kInvalidArgument: EMPTY_SKELETON, TOO_MANY_JOINTS, DUPLICATE_JOINT (name),
  /// BAD_PARENT (not an earlier joint; a cycle shows as this), NOT_FINITE (offset).
  static StatusOr<std::shared_ptr<const Skeleton>> Create(std::vector<Joint> joints);

  int num_joints() const { return static_cast<int>(joints_.size()); }
  const Joint& joint(int index) const { return joints_[index]; }
  const std::vector<Joint>& joints() const { return joints_; }
  int parent(int index) const { return joints_[index].parent; }
  std::span<const int> children(int index) const { return children_[index]; }

  /// Exact name, or nullopt.
  std::optional<int> Find(std::string_view name) const;
  /// Indices of `first`, its ancestors down to the root, in that order.
  std::vector<int> ChainToRoot(int first) const;

  /// Same names, parents, and offsets within `tolerance` metres.
  bool SameAs(const Skeleton& other, double tolerance = 1e-9) const;

 private:
  explicit Skeleton(std::vector<Joint> joints);

  std::vector<Joint> joints_;
  std::vector<std::vector<int>> children_;
};

using SkeletonPtr = std::shared_ptr<const Skeleton>;

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_SKELETON_H_
