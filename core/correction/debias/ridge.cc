#include "core/correction/debias/ridge.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numbers>
#include <utility>

namespace poise::correction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kChunk = 1024;  // frames that are in double precision at a time
constexpr int kJoints = 16;

// Outputs that share one weight: the root's way, then each joint.
struct OutputGroup {
  Index first, count;
};
constexpr int kGroups = 1 + kJoints;

OutputGroup Group(int i) { return i == 0 ? OutputGroup{0, 3} : OutputGroup{3 + 6 * (i - 1), 6}; }

// Frames `first` to `first + count` with a last column of ones, for the bias.
MatrixXd WithOnes(const FrameRows& inputs, Index first, Index count) {
  MatrixXd rows(count, inputs.cols() + 1);
  rows << inputs.middleRows(first, count).cast<double>(), Eigen::VectorXd::Ones(count);
  return rows;
}

// All that a linear map needs to know of frames.
struct Sums {
  MatrixXd gram;   // inputs by inputs
  MatrixXd cross;  // inputs by outputs
  double frames = 0;

  explicit Sums(const ActorFrames& actor)
      : gram(MatrixXd::Zero(actor.inputs.cols() + 1, actor.inputs.cols() + 1)),
        cross(MatrixXd::Zero(actor.inputs.cols() + 1, actor.corrections.cols())),
        frames(static_cast<double>(actor.inputs.rows())) {
    for (Index first = 0; first < actor.inputs.rows(); first += kChunk) {
      const Index count = std::min(kChunk, actor.inputs.rows() - first);
      const MatrixXd rows = WithOnes(actor.inputs, first, count);
      gram.noalias() += rows.transpose() * rows;
      cross.noalias() +=
          rows.transpose() * actor.corrections.middleRows(first, count).cast<double>();
    }
  }

  void Add(const Sums& other, double sign) {
    gram += sign * other.gram;
    cross += sign * other.cross;
    frames += sign * other.frames;
  }

  // (inputs and bias, outputs)
  MatrixXd Solve(double l2) const {
    MatrixXd penalised = gram;
    penalised.diagonal().head(gram.rows() - 1).array() += l2 * frames;
    return penalised.ldlt().solve(cross);
  }
};

// Sum over frames of the size of what is left, by group.
Eigen::VectorXd Left(const ActorFrames& actor, const MatrixXd& map) {
  Eigen::VectorXd left = Eigen::VectorXd::Zero(kGroups);
  for (Index first = 0; first < actor.inputs.rows(); first += kChunk) {
    const Index count = std::min(kChunk, actor.inputs.rows() - first);
    const MatrixXd errors = actor.corrections.middleRows(first, count).cast<double>() -
                            WithOnes(actor.inputs, first, count) * map;
    for (int g = 0; g < kGroups; ++g) {
      left[g] += errors.middleCols(Group(g).first, Group(g).count).rowwise().norm().sum();
    }
  }
  return left;
}

std::vector<Sums> SumsOf(const std::vector<ActorFrames>& actors) {
  return {actors.begin(), actors.end()};
}

Sums Total(const std::vector<Sums>& sums) {
  Sums total = sums.front();
  for (size_t i = 1; i < sums.size(); ++i) total.Add(sums[i], 1);
  return total;
}

void SetMap(const MatrixXd& map, OutputGroup outputs, RidgeFit& fit) {
  const Index inputs = map.rows() - 1;
  fit.weight.middleCols(outputs.first, outputs.count) =
      map.topRows(inputs).middleCols(outputs.first, outputs.count);
  fit.bias.segment(outputs.first, outputs.count) =
      map.row(inputs).segment(outputs.first, outputs.count);
}

RidgeFit NoCorrection(Index inputs) {
  return {.weight = MatrixXd::Zero(inputs, kCorrectionWidth),
          .bias = Eigen::RowVectorXd::Zero(kCorrectionWidth),
          .left_out_errors = {}};
}

double MeanJointError(const Eigen::VectorXd& left, double frames) {
  return left.tail(kJoints).sum() / (kJoints * frames * std::numbers::sqrt2);
}

}  // namespace

RidgeFit FitRidge(const std::vector<ActorFrames>& actors, double l2) {
  RidgeFit fit = NoCorrection(actors.front().inputs.cols());
  SetMap(Total(SumsOf(actors)).Solve(l2), {0, kCorrectionWidth}, fit);
  return fit;
}

RidgeFit FitRidgeByActors(const std::vector<ActorFrames>& actors) {
  const std::vector<Sums> sums = SumsOf(actors);
  const Sums total = Total(sums);
  const size_t none = kL2Candidates.size();
  std::vector<Eigen::VectorXd> left(none + 1, Eigen::VectorXd::Zero(kGroups));
  for (size_t i = 0; i < actors.size(); ++i) {
    Sums others = total;
    others.Add(sums[i], -1);
    for (size_t c = 0; c < none; ++c) left[c] += Left(actors[i], others.Solve(kL2Candidates[c]));
    left[none] += Left(actors[i], MatrixXd::Zero(total.gram.rows(), kCorrectionWidth));
  }
  RidgeFit fit = NoCorrection(actors.front().inputs.cols());
  for (size_t c = 0; c < none; ++c) {
    fit.left_out_errors.push_back(MeanJointError(left[c], total.frames));
    const MatrixXd map = total.Solve(kL2Candidates[c]);
    for (int g = 0; g < kGroups; ++g) {
      const auto better = [g](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
        return a[g] < b[g];
      };
      if (std::min_element(left.begin(), left.end(), better) == left.begin() + c) {
        SetMap(map, Group(g), fit);
      }
    }
  }
  fit.left_out_uncorrected = MeanJointError(left[none], total.frames);
  return fit;
}

}  // namespace poise::correction
