#include "core/push/learned/network_layers.h"

#include <array>

namespace poise::push {
namespace {

StatusOr<LinearLayer> ReadLayer(const base::TensorFile& file, const std::string& weight,
                                const std::string& bias, int in, int out) {
  POISE_ASSIGN_OR_RETURN(const std::vector<float> w,
                         file.Floats(weight, std::array<int64_t, 2>{out, in}));
  POISE_ASSIGN_OR_RETURN(const std::vector<float> b,
                         file.Floats(bias, std::array<int64_t, 1>{out}));
  return LinearLayer{Eigen::Map<const MatrixXf>(w.data(), out, in),
                     Eigen::Map<const Eigen::RowVectorXf>(b.data(), out)};
}

}  // namespace

StatusOr<LinearLayer> LinearLayer::Read(const base::TensorFile& file, const std::string& name,
                                        int in, int out) {
  return ReadLayer(file, name + ".weight", name + ".bias", in, out);
}

MatrixXf LinearLayer::operator()(const MatrixXf& input) const {
  MatrixXf output = input * weight.transpose();
  output.rowwise() += bias;
  return output;
}

StatusOr<GruLayer> GruLayer::Read(const base::TensorFile& file, const std::string& name,
                                  const std::string& suffix, int in, int hidden) {
  GruLayer layer;
  POISE_ASSIGN_OR_RETURN(layer.input, ReadLayer(file, name + "weight_ih" + suffix,
                                                name + "bias_ih" + suffix, in, 3 * hidden));
  POISE_ASSIGN_OR_RETURN(layer.hidden, ReadLayer(file, name + "weight_hh" + suffix,
                                                 name + "bias_hh" + suffix, hidden, 3 * hidden));
  return layer;
}

void GruLayer::Step(const MatrixXf& in, MatrixXf& memory) const {
  const auto size = memory.cols();
  const MatrixXf from_input = input(in), from_memory = hidden(memory);
  const auto sum = [&](int gate) {
    return (from_input.middleCols(gate * size, size) + from_memory.middleCols(gate * size, size))
        .array();
  };
  const Eigen::ArrayXXf reset = 1 / (1 + (-sum(0)).exp());
  const Eigen::ArrayXXf update = 1 / (1 + (-sum(1)).exp());
  const Eigen::ArrayXXf candidate =
      (from_input.rightCols(size).array() + reset * from_memory.rightCols(size).array()).tanh();
  memory = ((1 - update) * candidate + update * memory.array()).matrix();
}

}  // namespace poise::push
