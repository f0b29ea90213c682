#include "core/push/restoration/rigid_fit.h"

#include <Eigen/SVD>
#include <vector>

namespace poise::push {
namespace {

using Children = std::array<std::vector<int>, kBodyJoints>;

const Children& ChildrenOfJoints() {
  static const Children children = [] {
    Children list;
    for (int joint = 1; joint < kBodyJoints; ++joint) list[kBodyParents[joint]].push_back(joint);
    return list;
  }();
  return children;
}

// The rotation that turns bones `from` onto `to` best (Kabsch).
math::Quat BestRotation(const math::Mat3& covariance) {
  const Eigen::JacobiSVD<math::Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  math::Mat3 flip = math::Mat3::Identity();
  flip(2, 2) = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
  return math::Quat(svd.matrixV() * flip * svd.matrixU().transpose()).normalized();
}

}  // namespace

BodyTurns FitTurns(const BodyShape& first, const BodyShape& wanted) {
  BodyTurns turns;
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    const int parent = kBodyParents[joint];
    const math::Quat before = parent < 0 ? math::Quat::Identity() : turns[parent];
    const std::vector<int>& children = ChildrenOfJoints()[joint];
    turns[joint] = before;
    if (children.size() == 1) {
      const Vec3 bone = first[children[0]] - first[joint];
      const Vec3 now = wanted[children[0]] - wanted[joint];
      turns[joint] = (math::SwingBetween(before * bone, now) * before).normalized();
    } else if (children.size() > 1) {
      math::Mat3 covariance = math::Mat3::Zero();
      for (const int child : children) {
        covariance += (first[child] - first[joint]) * (wanted[child] - wanted[joint]).transpose();
      }
      turns[joint] = BestRotation(covariance);
    }
  }
  return turns;
}

BodyShape Turned(const BodyShape& first, const BodyTurns& turns) {
  BodyShape joints;
  joints[0] = first[0];
  for (int joint = 1; joint < kBodyJoints; ++joint) {
    const int parent = kBodyParents[joint];
    joints[joint] = joints[parent] + turns[parent] * (first[joint] - first[parent]);
  }
  return joints;
}

}  // namespace poise::push
