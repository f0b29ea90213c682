#include "core/learning/rl/fast_mlp.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

namespace poise::rl {
namespace {

constexpr std::align_val_t kAlignment{64};  // a cache line, and the widest vector

AlignedFloats AllocateAligned(size_t size) {
  return AlignedFloats(static_cast<float*>(operator new(size * sizeof(float), kAlignment)));
}

// One build of the kernel.
struct Build {
  int panel_width;
  void (*kernel)(const LayerArguments&);
};

Build BuildFor(base::Isa isa) {
  switch (isa) {
    case base::Isa::kV4:
      return {isa_v4::kPanelWidth, isa_v4::LayerKernel};
    case base::Isa::kV3:
      return {isa_v3::kPanelWidth, isa_v3::LayerKernel};
    case base::Isa::kV2:
      break;
  }
  return {isa_v2::kPanelWidth, isa_v2::LayerKernel};
}

int NumPanels(const LayerWeights& layer, int width) {
  return (static_cast<int>(layer.bias.size()) + width - 1) / width;
}

size_t PackedSize(const LayerWeights& layer, int width) {
  return static_cast<size_t>(NumPanels(layer, width)) * width * (layer.weight.cols() + 1);
}

// Writes weights, then biases, as LayerArguments wants them.
void Pack(const LayerWeights& layer, Eigen::Index width, float* out) {
  for (Eigen::Index first = 0; first < layer.bias.size(); first += width) {
    const Eigen::Index rows = std::min(width, layer.bias.size() - first);
    for (Eigen::Index k = 0; k < layer.weight.cols(); ++k, out += width) {
      std::copy_n(&layer.weight(first, k), rows, out);
      std::fill(out + rows, out + width, 0.0f);
    }
  }
  std::copy_n(layer.bias.data(), layer.bias.size(), out);
  std::fill(out + layer.bias.size(), out + NumPanels(layer, width) * width, 0.0f);
}

Status Check(const std::vector<LayerWeights>& layers) {
  if (layers.empty()) {
    return base::InvalidArgument("NO_LAYERS", "layers", "a network needs at least one layer");
  }
  for (size_t i = 0; i < layers.size(); ++i) {
    const auto& [weight, bias] = layers[i];
    const std::string field = fmt::format("layers[{}]", i);
    if (weight.size() == 0 || bias.size() != weight.rows() ||
        (i > 0 && weight.cols() != layers[i - 1].weight.rows())) {
      return base::InvalidArgument(
          "LAYER_SIZE_MISMATCH", field,
          fmt::format("weight is {} x {}, bias {}; expected (out, in) with in = the outputs of the "
                      "layer before, and out numbers in the bias",
                      weight.rows(), weight.cols(), bias.size()));
    }
    if (!weight.allFinite() || !bias.allFinite()) {
      return base::InvalidArgument("WEIGHT_NOT_FINITE", field, "a weight or bias is not finite");
    }
  }
  return absl::OkStatus();
}

}  // namespace

void FreeAligned::operator()(float* numbers) const { operator delete(numbers, kAlignment); }

StatusOr<FastMlp> FastMlp::Create(const std::vector<LayerWeights>& layers, Activation activation,
                                  base::Isa isa) {
  POISE_RETURN_IF_ERROR(Check(layers));
  const auto [width, kernel] = BuildFor(std::min(isa, base::BestIsa()));
  size_t size = 0;
  for (const LayerWeights& layer : layers) size += PackedSize(layer, width);
  AlignedFloats memory = AllocateAligned(size);
  FastMlp mlp;
  mlp.kernel_ = kernel;
  float* packed = memory.get();
  for (const LayerWeights& layer : layers) {
    Pack(layer, width, packed);
    LayerArguments arguments = {};
    arguments.num_inputs = static_cast<int>(layer.weight.cols());
    arguments.num_panels = NumPanels(layer, width);
    arguments.output_stride = static_cast<long>(arguments.num_panels) * width;
    arguments.weights = packed;
    arguments.bias = packed + arguments.num_inputs * arguments.output_stride;
    arguments.nonlinearity =
        activation == Activation::kRelu ? Nonlinearity::kRelu : Nonlinearity::kTanh;
    mlp.layers_.push_back(arguments);
    mlp.widest_ = std::max(mlp.widest_, static_cast<int>(arguments.output_stride));
    packed += PackedSize(layer, width);
  }
  mlp.layers_.back().nonlinearity = Nonlinearity::kNone;
  mlp.output_size_ = static_cast<int>(layers.back().bias.size());
  mlp.memory_ = std::move(memory);
  return mlp;
}

void FastMlp::Forward(std::span<const float> input, int batch, std::span<float> output,
                      Scratch& scratch) const {
  const size_t needed = static_cast<size_t>(batch) * widest_;
  if (scratch.size < needed) {
    for (AlignedFloats& buffer : scratch.buffers) buffer = AllocateAligned(needed);
    scratch.size = needed;
  }
  const float* from = input.data();
  long stride = input_size();
  for (size_t i = 0; i < layers_.size(); ++i) {
    LayerArguments layer = layers_[i];
    layer.batch = batch;
    layer.input = from;
    layer.input_stride = stride;
    layer.output = scratch.buffers[i % 2].get();
    kernel_(layer);
    from = layer.output;
    stride = layer.output_stride;
  }
  for (int sample = 0; sample < batch; ++sample) {
    std::copy_n(from + sample * stride, output_size_, output.data() + sample * output_size_);
  }
}

}  // namespace poise::rl
