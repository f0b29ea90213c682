#include "core/push/ldp/body_rows.h"

#include <numeric>

#include "core/push/ldp/pendulum_tensors.h"
#include "core/push/ldp/take_tensors.h"
#include "core/push/restoration/pose_features.h"
#include "core/push/takes/onset.h"

namespace poise::push::ldp {
namespace {

using torch::Tensor;

constexpr double kMillimetres = 1000;

Tensor ToTensor(const Eigen::MatrixXd& matrix) {
  const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows =
      matrix.cast<float>();
  return torch::from_blob(const_cast<float*>(rows.data()), {rows.rows(), rows.cols()},
                          torch::kFloat32)
      .clone();
}

// Features of the frames from `onset` on, but the last.
Tensor PartRows(const TakePerson& person, int onset, const std::vector<int>& joints) {
  const auto skipped = static_cast<size_t>(onset) * kBodyJoints;
  const BodyMotion motion{person.frames() - onset, std::span(person.joints).subspan(skipped),
                          std::span(person.rotations).subspan(skipped)};
  Eigen::MatrixXd features = PoseFeatures(motion, joints);
  const Vec3 hip = person.joint(0, kPelvis);
  for (size_t i = 0; i < joints.size(); ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      features.col(3 + 3 * static_cast<int>(i) + axis).array() -= kMillimetres * hip[axis];
    }
  }
  return ToTensor(features);
}

Tensor PendulumRows(const TakePerson& person, int onset) {
  const PendulumPose first = RecordedPendulum(person, 0);
  Eigen::MatrixXd position(person.frames() - onset, 4);
  for (int frame = onset; frame < person.frames(); ++frame) {
    position.row(frame - onset) = RecordedPendulum(person, frame).position.transpose();
  }
  const Vec3 hip = person.joint(0, kPelvis);
  position.col(0).array() -= hip.x();
  position.col(1).array() -= hip.y();
  return PendulumFeatures(ToTensor(position), torch::tensor(first.rod, torch::kFloat32),
                          torch::tensor(first.cart_height, torch::kFloat32), torch::zeros({2}));
}

}  // namespace

std::vector<std::vector<int>> BodyParts(const std::string& parts) {
  if (parts == "full") {
    std::vector<int> all(kBodyJoints);
    std::iota(all.begin(), all.end(), 0);
    return {all};
  }
  return {{kLowerBody.begin(), kLowerBody.end()}, {kUpperBody.begin(), kUpperBody.end()}};
}

Tensor PendulumFeatures(const Tensor& position, const Tensor& rod, const Tensor& cart_height,
                        const Tensor& origin) {
  const Tensor place = position.slice(-1, 0, 2) - origin.unsqueeze(-2);
  const Tensor placed = torch::cat({place, position.slice(-1, 2)}, -1);
  const Tensor rods = rod.unsqueeze(-1).expand_as(placed.select(-1, 0));
  const Tensor ends = RodEnds(placed, rods, cart_height.unsqueeze(-1));
  const auto now = [](const Tensor& path) { return path.slice(-2, 0, -1); };
  const auto change = [&](const Tensor& path) { return path.slice(-2, 1) - now(path); };
  return torch::cat({now(placed), now(ends), now(rods.unsqueeze(-1)), change(placed), change(ends)},
                    -1);
}

std::vector<int64_t> BodyRows::Starts(int64_t rollout, int64_t stride) const {
  std::vector<int64_t> starts;
  for (size_t i = 0; i + 1 < first_rows.size(); ++i) {
    for (int64_t row = first_rows[i]; row + rollout < first_rows[i + 1]; row += stride) {
      starts.push_back(row);
    }
  }
  return starts;
}

BodyRows MakeBodyRows(const std::vector<PersonRef>& people,
                      const std::vector<std::vector<int>>& parts) {
  std::vector<std::vector<Tensor>> rows(parts.size());
  std::vector<Tensor> pendulum;
  BodyRows all;
  int64_t count = 0;
  for (const PersonRef& ref : people) {
    const TakePerson& person = ref.take->people[ref.person];
    const int onset = RecordedOnset(person, ref.person == 0);
    if (onset < 0 || onset + 2 > person.frames()) continue;
    for (size_t part = 0; part < parts.size(); ++part) {
      rows[part].push_back(PartRows(person, onset, parts[part]));
    }
    pendulum.push_back(PendulumRows(person, onset));
    all.first_rows.push_back(count);
    count += pendulum.back().size(0);
  }
  all.first_rows.push_back(count);
  for (const auto& part : rows) all.parts.push_back(torch::cat(part));
  all.pendulum = torch::cat(pendulum);
  return all;
}

std::vector<Tensor> FirstFeatures(const TakePerson& person,
                                  const std::vector<std::vector<int>>& parts) {
  // Two frames in which nothing moves.
  TakePerson still;
  for (int frame = 0; frame < 2; ++frame) {
    const auto pose = person.pose(0);
    still.joints.insert(still.joints.end(), pose.begin(), pose.end());
    still.rotations.insert(still.rotations.end(), person.rotations.begin(),
                           person.rotations.begin() + kBodyJoints);
  }
  std::vector<Tensor> features;
  for (const auto& joints : parts) features.push_back(PartRows(still, 0, joints));
  return features;
}

}  // namespace poise::push::ldp
