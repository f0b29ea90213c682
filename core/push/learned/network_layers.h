#ifndef POISE_CORE_PUSH_LEARNED_NETWORK_LAYERS_H_
#define POISE_CORE_PUSH_LEARNED_NETWORK_LAYERS_H_

#include <Eigen/Core>
#include <string>

#include "core/base/status.h"
#include "core/base/tensor_file.h"

/// The layers of the push networks without LibTorch, for forecasts; rows are people.
namespace poise::push {

using MatrixXf = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A vector on the floor of each person.
using FloorVectors = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Linear layer: y = x W^T + b.
struct LinearLayer {
  MatrixXf weight;          // (out, in)
  Eigen::RowVectorXf bias;  // (out)

  /// Reads "NAME.weight" and "NAME.bias". Errors: those of TensorFile::Floats.
  static StatusOr<LinearLayer> Read(const base::TensorFile& file, const std::string& name, int in,
                                    int out);
  MatrixXf operator()(const MatrixXf& input) const;
};

/// Gated recurrent unit with LibTorch's gates (reset, update, new) and weights.
struct GruLayer {
  LinearLayer input;   // (3 hidden, in)
  LinearLayer hidden;  // (3 hidden, hidden)

  /// Reads "NAMEweight_ih`suffix`" and so on; the suffix is "" of a cell, "_l0" of a sequence's.
  static StatusOr<GruLayer> Read(const base::TensorFile& file, const std::string& name,
                                 const std::string& suffix, int in, int hidden);
  /// Replaces `memory` (people, hidden).
  void Step(const MatrixXf& input, MatrixXf& memory) const;
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_NETWORK_LAYERS_H_
