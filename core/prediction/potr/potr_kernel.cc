#include "core/prediction/potr/potr_kernel.h"

#include <cmath>

#include "core/prediction/network/layer_kernels.h"

namespace poise::prediction::POISE_KERNEL_ISA {
namespace {

// Each frame's features: (past, width).
Matrix Embed(const PotrArguments& a, const ConstMap& past) {
  const PotrSizes& s = a.sizes;
  const int nodes = s.columns / 3;
  Matrix joints(nodes, 3), h(nodes, s.node_width), t(nodes, s.node_width), u(nodes, s.node_width);
  Matrix product(nodes, s.node_width), narrow(nodes, s.joint_width), last(nodes, s.joint_width);
  Matrix flat(s.past, nodes * s.joint_width);
  for (int frame = 0; frame < s.past; ++frame) {
    joints = ConstMap(past.row(frame).data(), nodes, 3);
    Convolve(a.graphs[0], joints, product, h);
    Convolve(a.graphs[1], h, product, t);
    Convolve(a.graphs[2], t, product, u);
    h += u;
    Convolve(a.graphs[3], h, narrow, last);
    flat.row(frame) = Row(last.data(), last.size());
  }
  Matrix embedded(s.past, s.width);
  Apply(a.frame, flat, embedded);
  return embedded;
}

// One of query, key and value.
Matrix Part(const LayerWeights& in, int part, const Matrix& x) {
  const long width = x.cols();
  const LayerWeights own{in.weight + part * width * width, in.bias + part * width};
  Matrix out(x.rows(), width);
  Apply(own, x, out);
  return out;
}

Matrix Attend(const AttentionWeights& weights, int heads, const Matrix& query, const Matrix& key,
              const Matrix& value) {
  const Matrix q = Part(weights.in, 0, query), k = Part(weights.in, 1, key),
               v = Part(weights.in, 2, value);
  const long width = q.cols(), part = width / heads;
  const float scale = 1 / std::sqrt(static_cast<float>(part));
  Matrix said(q.rows(), width), scores(q.rows(), k.rows());
  for (int head = 0; head < heads; ++head) {
    const long first = head * part;
    scores.noalias() = q.middleCols(first, part) * k.middleCols(first, part).transpose();
    scores = ((scores.colwise() - scores.rowwise().maxCoeff()) * scale).array().exp();
    said.middleCols(first, part).noalias() = scores * v.middleCols(first, part);
    said.middleCols(first, part).array().colwise() /= scores.rowwise().sum().array();
  }
  Matrix out(q.rows(), width);
  Apply(weights.out, said, out);
  return out;
}

Matrix Perceptron(const LayerWeights& up, const LayerWeights& down, int hidden, const Matrix& x) {
  Matrix wide(x.rows(), hidden), out(x.rows(), x.cols());
  Apply(up, x, wide);
  wide = wide.cwiseMax(0.0F);
  Apply(down, wide, out);
  return out;
}

Matrix Encode(const PotrArguments& a, Matrix x) {
  Matrix n(x.rows(), x.cols());
  for (int i = 0; i < a.sizes.layers; ++i) {
    const PotrEncoderLayer& layer = a.encoder[i];
    Normalise(x, layer.norm1, n);
    const Matrix placed = n + ConstMap(a.positions, n.rows(), n.cols());
    x += Attend(layer.attention, a.sizes.heads, placed, placed, n);
    Normalise(x, layer.norm2, n);
    x += Perceptron(layer.up, layer.down, a.sizes.hidden, n);
  }
  return x;
}

Matrix Decode(const PotrArguments& a, Matrix x, const Matrix& memory) {
  Matrix n(x.rows(), x.cols());
  for (int i = 0; i < a.sizes.layers; ++i) {
    const PotrDecoderLayer& layer = a.decoder[i];
    Normalise(x, layer.norm1, n);
    const Matrix placed = n + ConstMap(a.positions, n.rows(), n.cols());
    x += Attend(layer.self, a.sizes.heads, placed, placed, placed);
    Normalise(x, layer.norm2, n);
    x = n + Attend(layer.cross, a.sizes.heads, n, memory, memory);
    Normalise(x, layer.norm3, n);
    x = Perceptron(layer.up, layer.down, a.sizes.hidden, n);
    if (a.residual) x += n;
  }
  return x;
}

}  // namespace

void PotrKernel(const PotrArguments& a) {
  const PotrSizes& s = a.sizes;
  for (int i = 0; i < a.batch; ++i) {
    const long motion = static_cast<long>(i) * s.columns;
    const ConstMap past(a.inputs + motion * s.past, s.past, s.columns);
    const Matrix embedded = Embed(a, past);
    const Matrix memory = Encode(a, embedded.topRows(s.past - 1));
    const Matrix said = Decode(a, embedded.bottomRows(1).replicate(s.future, 1), memory);
    Matrix poses(s.future, s.columns);
    Apply(a.pose, said, poses);
    poses.rowwise() += past.row(s.past - 1);
    Eigen::Map<Matrix>(a.outputs + motion * s.future, s.future, s.columns) = poses;
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
