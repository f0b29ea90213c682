#include "core/prediction/gcn/gcn_kernel.h"

#include "core/prediction/network/layer_kernels.h"

namespace poise::prediction::POISE_KERNEL_ISA {

void GcnKernel(const GcnArguments& a) {
  const int frames = a.past + a.future;
  const ConstMap dct(a.dct, a.coefficients, frames);
  Matrix seen(frames, a.nodes), h(a.nodes, a.width), t(a.nodes, a.width), u(a.nodes, a.width);
  Matrix wide(a.nodes, a.width), out(a.nodes, a.coefficients), product(a.nodes, a.coefficients);
  for (int i = 0; i < a.batch; ++i) {
    const long motion = static_cast<long>(i) * a.nodes;
    seen.topRows(a.past) = ConstMap(a.inputs + motion * a.past, a.past, a.nodes);
    seen.bottomRows(a.future).rowwise() = seen.row(a.past - 1);
    const Matrix x = (dct * seen).transpose();
    Convolve(a.layers[0], x, wide, h);
    for (int block = 0; block < a.blocks; ++block) {
      Convolve(a.layers[2 * block + 1], h, wide, t);
      Convolve(a.layers[2 * block + 2], t, wide, u);
      h += u;
    }
    Convolve(a.layers[2 * a.blocks + 1], h, product, out);
    Eigen::Map<Matrix>(a.outputs + motion * a.future, a.future, a.nodes).noalias() =
        dct.rightCols(a.future).transpose() * (out + x).transpose();
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
