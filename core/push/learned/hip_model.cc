#include "core/push/learned/hip_model.h"

#include <algorithm>
#include <cmath>

#include "core/push/body_joints.h"

namespace poise::push {

HipStates HipStates::Standing(int people, int hidden) {
  const FloorVectors zero = FloorVectors::Zero(people, 2);
  return {zero, zero, zero, zero, MatrixXf::Zero(people, hidden)};
}

StatusOr<HipModel> HipModel::Read(const base::TensorFile& file, const std::string& prefix,
                                  const HipConfig& config) {
  HipModel model;
  model.config_ = config;
  POISE_ASSIGN_OR_RETURN(model.message_in_, LinearLayer::Read(file, prefix + "message_in",
                                                              kPairSize, config.message_hidden));
  POISE_ASSIGN_OR_RETURN(
      model.message_out_,
      LinearLayer::Read(file, prefix + "message_out", config.message_hidden, config.message));
  POISE_ASSIGN_OR_RETURN(model.cell_,
                         GruLayer::Read(file, prefix + "cell.", "",
                                        kOwnSize + config.message + kContextSize, config.hidden));
  POISE_ASSIGN_OR_RETURN(model.drive_,
                         LinearLayer::Read(file, prefix + "drive", config.hidden, kDriveSize));
  return model;
}

HipInfluence HipInfluence::None(int people) {
  const FloorVectors zero = FloorVectors::Zero(people, 2);
  return {FacingX(people),
          zero,
          zero,
          MatrixXf::Zero(people, kContextSize),
          zero,
          Eigen::VectorXf::Ones(people)};
}

MatrixXf HipModel::Messages(const HipInfluence& influence, const std::vector<Pair>& pairs,
                            const HipStates& states) const {
  const FloorVectors& place = influence.place;
  MatrixXf sum = MatrixXf::Zero(place.rows(), config_.message);
  if (!config_.messages || pairs.empty()) return sum;
  // Everybody in the ground frame, then the other in one's own.
  FloorVectors hip = place, rate(place.rows(), 2), lean(place.rows(), 2);
  for (Eigen::Index i = 0; i < place.rows(); ++i) {
    const Eigen::RowVector2f heading = influence.headings.row(i);
    hip.row(i) += ToGround(heading, states.hip.row(i));
    rate.row(i) = ToGround(heading, states.hip_rate.row(i));
    lean.row(i) = ToGround(heading, {states.lean(i, 0), -states.lean(i, 1)});
  }
  // Two rows a pair: what the second says to the first, and the other way round.
  MatrixXf input(2 * pairs.size(), kPairSize);
  const auto fill = [&](auto row, int own, int other) {
    const Eigen::RowVector2f heading = influence.headings.row(own);
    const Eigen::RowVector2f away = hip.row(own) - hip.row(other);
    const Eigen::RowVector2f other_lean = FromGround(heading, lean.row(other));
    const Eigen::RowVector2f other_rate = FromGround(heading, rate.row(other));
    row << FromGround(heading, away), states.hip_rate.row(own) - other_rate,
        std::sqrt(away.squaredNorm() + 1e-6f), float{kLeanScale} * states.lean.row(own),
        states.hip_rate.row(own), float{kLeanScale} * other_lean.x(),
        float{kLeanScale} * -other_lean.y(), other_rate;
  };
  for (size_t i = 0; i < pairs.size(); ++i) {
    fill(input.row(2 * i), pairs[i].first, pairs[i].second);
    fill(input.row(2 * i + 1), pairs[i].second, pairs[i].first);
  }
  const MatrixXf message = message_out_(message_in_(input).array().tanh().matrix());
  const auto reach = static_cast<float>(config_.reach_m);
  for (Eigen::Index i = 0; i < message.rows(); ++i) {
    const float near = input(i, 4) / reach;
    const float nearness = std::max(0.0f, 1 - near * near);
    const Pair& pair = pairs[i / 2];
    sum.row(i % 2 == 0 ? pair.first : pair.second) += nearness * nearness * message.row(i);
  }
  return sum;
}

void HipModel::Step(const HipInfluence& influence, const std::vector<Pair>& pairs,
                    HipStates& states, FloorVectors* message_effect) const {
  constexpr auto kStep = static_cast<float>(kFrameTime);
  // How people come to rest once the network no longer moves them.
  constexpr float kBraking = 4;                        // [1/s]
  constexpr float kUprighting = 16, kLeanBraking = 8;  // [1/s^2], [1/s]: without overshoot
  MatrixXf input(influence.place.rows(), kOwnSize + config_.message + kContextSize);
  input << states.hip_rate, states.hip, float{kLeanScale} * states.lean, states.lean_rate,
      static_cast<float>(kPushScale) * influence.push, Messages(influence, pairs, states),
      influence.context;
  MatrixXf untold = states.memory;
  cell_.Step(input, states.memory);
  const MatrixXf drive = drive_(states.memory);
  const auto active = influence.activity.asDiagonal();
  const Eigen::VectorXf rest = 1 - influence.activity.array();
  const auto passive = rest.asDiagonal();
  if (message_effect != nullptr) {
    input.middleCols(kOwnSize, config_.message).setZero();
    cell_.Step(input, untold);
    *message_effect = active * (float{kHipAcceleration} * (drive - drive_(untold)).leftCols<2>());
  }
  FloorVectors hip = active * (float{kHipAcceleration} * drive.leftCols<2>() + influence.push);
  hip += influence.contact - passive * (kBraking * states.hip_rate);
  states.hip_rate += kStep * hip;
  states.hip += kStep * states.hip_rate;
  FloorVectors lean = active * (float{kLeanAcceleration} * drive.rightCols<2>());
  lean -= passive * (kUprighting * states.lean + kLeanBraking * states.lean_rate);
  states.lean_rate += kStep * lean;
  states.lean += kStep * states.lean_rate;
}

}  // namespace poise::push
