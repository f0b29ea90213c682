#include "core/prediction/gcn/gcn_kernel.h"

// GCC 12 takes the operand that AVX-512 intrinsics leave unset for a variable in use.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <Eigen/Core>

namespace poise::prediction::POISE_KERNEL_ISA {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstMap = Eigen::Map<const Matrix>;

void Convolve(const GcnLayer& layer, const Matrix& in, Matrix& product, Matrix& out) {
  product.noalias() = in * ConstMap(layer.weight, in.cols(), out.cols());
  out.noalias() = ConstMap(layer.graph, in.rows(), in.rows()) * product;
  out.rowwise() += Eigen::Map<const Eigen::RowVectorXf>(layer.bias, out.cols());
}

void ConvolveAndBend(const GcnLayer& layer, const Matrix& in, Matrix& product, Matrix& out) {
  Convolve(layer, in, product, out);
  out.array() = (out.array() * ConstMap(layer.scale, out.rows(), out.cols()).array() +
                 ConstMap(layer.shift, out.rows(), out.cols()).array())
                    .tanh();
}

}  // namespace

void GcnKernel(const GcnArguments& a) {
  const ConstMap dct(a.dct, a.frames, a.frames);
  Matrix h(a.nodes, a.width), t(a.nodes, a.width), u(a.nodes, a.width), wide(a.nodes, a.width);
  Matrix out(a.nodes, a.frames), product(a.nodes, a.frames);
  for (int i = 0; i < a.batch; ++i) {
    const long offset = static_cast<long>(i) * a.frames * a.nodes;
    const Matrix x = (dct * ConstMap(a.motion + offset, a.frames, a.nodes)).transpose();
    ConvolveAndBend(a.layers[0], x, wide, h);
    for (int block = 0; block < a.blocks; ++block) {
      ConvolveAndBend(a.layers[2 * block + 1], h, wide, t);
      ConvolveAndBend(a.layers[2 * block + 2], t, wide, u);
      h += u;
    }
    Convolve(a.layers[2 * a.blocks + 1], h, product, out);
    Eigen::Map<Matrix>(a.predicted + offset, a.frames, a.nodes).noalias() =
        dct.transpose() * (out + x).transpose();
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
