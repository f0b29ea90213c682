#include "core/motion/skeleton.h"

#include <fmt/format.h>

#include <unordered_set>

namespace poise::motion {

StatusOr<SkeletonPtr> Skeleton::Create(std::vector<Joint> joints) {
  if (joints.empty()) {
    return base::InvalidArgument("EMPTY_SKELETON", "skeleton.joints", "skeleton has no joints");
  }
  if (joints.size() > kMaxJoints) {
    return base::InvalidArgument(
        "TOO_MANY_JOINTS", "skeleton.joints",
        fmt::format("skeleton has {} joints, at most {} expected", joints.size(), kMaxJoints));
  }
  std::unordered_set<std::string_view> names;
  for (size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const std::string field = fmt::format("skeleton.joints[{}]", i);
    if (!names.insert(joint.name).second) {
      return base::InvalidArgument("DUPLICATE_JOINT", field,
                                   fmt::format("two joints are named '{}'", joint.name));
    }
    const bool is_root = i == 0;
    if (is_root ? joint.parent != -1 : joint.parent < 0 || joint.parent >= static_cast<int>(i)) {
      return base::InvalidArgument(
          "BAD_PARENT", field,
          fmt::format("joint '{}' (index {}) has parent {}{}", joint.name, i, joint.parent,
                      is_root ? ", the first joint must be the root (parent -1)"
                              : ", expected the index of an earlier joint"));
    }
    if (!joint.offset.allFinite() || (joint.end_site && !joint.end_site->allFinite())) {
      return base::InvalidArgument(
          "NOT_FINITE", field,
          fmt::format("joint '{}' has an offset that is no number", joint.name));
    }
  }
  return SkeletonPtr(new Skeleton(std::move(joints)));
}

Skeleton::Skeleton(std::vector<Joint> joints)
    : joints_(std::move(joints)), children_(joints_.size()) {
  for (int i = 1; i < num_joints(); ++i) children_[joints_[i].parent].push_back(i);
}

std::optional<int> Skeleton::Find(std::string_view name) const {
  for (int i = 0; i < num_joints(); ++i) {
    if (joints_[i].name == name) return i;
  }
  return std::nullopt;
}

std::vector<int> Skeleton::ChainToRoot(int first) const {
  std::vector<int> chain;
  for (int i = first; i >= 0; i = joints_[i].parent) chain.push_back(i);
  return chain;
}

bool Skeleton::SameAs(const Skeleton& other, double tolerance) const {
  if (num_joints() != other.num_joints()) return false;
  for (int i = 0; i < num_joints(); ++i) {
    const Joint &a = joints_[i], &b = other.joints_[i];
    if (a.name != b.name || a.parent != b.parent || (a.offset - b.offset).norm() > tolerance) {
      return false;
    }
  }
  return true;
}

}  // namespace poise::motion
