#include "core/push/learned/hip_model.h"

#include <algorithm>
#include <cmath>

#include "core/push/body_joints.h"

namespace poise::push {

HipStates HipStates::Standing(int people, int hidden) {
  const MatrixXf zero = MatrixXf::Zero(people, 2);
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

MatrixXf HipModel::Messages(const MatrixXf& place, const std::vector<Pair>& pairs,
                            const HipStates& states) const {
  MatrixXf sum = MatrixXf::Zero(place.rows(), config_.message);
  if (!config_.messages || pairs.empty()) return sum;
  // Two rows a pair: what the second says to the first, and the other way round.
  MatrixXf input(2 * pairs.size(), kPairSize);
  const auto fill = [&](auto row, int own, int other) {
    const Eigen::RowVector2f away =
        place.row(own) + states.hip.row(own) - place.row(other) - states.hip.row(other);
    row << away, states.hip_rate.row(own) - states.hip_rate.row(other),
        std::sqrt(away.squaredNorm() + 1e-6f), float{kLeanScale} * states.lean.row(own),
        states.hip_rate.row(own), float{kLeanScale} * states.lean.row(other),
        states.hip_rate.row(other);
  };
  for (size_t i = 0; i < pairs.size(); ++i) {
    fill(input.row(2 * i), pairs[i].first, pairs[i].second);
    fill(input.row(2 * i + 1), pairs[i].second, pairs[i].first);
  }
  const MatrixXf message = message_out_(message_in_(input).array().tanh().matrix());
  const auto reach = static_cast<float>(config_.reach_m);
  for (Eigen::Index i = 0; i < message.rows(); ++i) {
    const float nearness = std::max(0.0f, 1 - std::pow(input(i, 4) / reach, 2.0f));
    const Pair& pair = pairs[i / 2];
    sum.row(i % 2 == 0 ? pair.first : pair.second) += nearness * nearness * message.row(i);
  }
  return sum;
}

void HipModel::Step(const MatrixXf& place, const MatrixXf& push, const MatrixXf& context,
                    const std::vector<Pair>& pairs, HipStates& states) const {
  constexpr auto kStep = static_cast<float>(kFrameTime);
  MatrixXf input(place.rows(), kOwnSize + config_.message + kContextSize);
  input << states.hip_rate, states.hip, float{kLeanScale} * states.lean, states.lean_rate,
      static_cast<float>(kPushScale) * push, Messages(place, pairs, states), context;
  cell_.Step(input, states.memory);
  const MatrixXf drive = drive_(states.memory);
  states.hip_rate += kStep * (float{kHipAcceleration} * drive.leftCols<2>() + push);
  states.hip += kStep * states.hip_rate;
  states.lean_rate += kStep * float{kLeanAcceleration} * drive.rightCols<2>();
  states.lean += kStep * states.lean_rate;
}

}  // namespace poise::push
