#include "core/prediction/simlpe/simlpe_kernel.h"

#include "core/prediction/network/layer_kernels.h"

namespace poise::prediction::POISE_KERNEL_ISA {

void SimlpeKernel(const SimlpeArguments& a) {
  const ConstMap dct(a.dct, a.past, a.past);
  Matrix h(a.past, a.columns), mixed(a.past, a.columns), normed(a.past, a.columns);
  for (int i = 0; i < a.batch; ++i) {
    const long motion = static_cast<long>(i) * a.columns;
    const ConstMap past(a.inputs + motion * a.past, a.past, a.columns);
    Apply(a.in, dct * past, h);
    for (int b = 0; b < a.blocks; ++b) {
      const SimlpeBlock& block = a.layers[b];
      mixed.noalias() = Weight(block.along_time, a.past, a.past) * h;
      mixed.colwise() += Row(block.along_time.bias, a.past).transpose();
      Normalise(mixed, block.norm, normed);
      h += normed;
    }
    Apply(a.out, h, mixed);
    Eigen::Map<Matrix> future(a.outputs + motion * a.future, a.future, a.columns);
    future.noalias() = dct.leftCols(a.future).transpose() * mixed;
    future.rowwise() += past.row(a.past - 1);
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
