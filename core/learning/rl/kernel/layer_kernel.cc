#include "core/learning/rl/kernel/layer_kernel.h"

#include "core/learning/rl/kernel/vector.h"

namespace poise::rl::POISE_KERNEL_ISA {
namespace {

// Sums that fit into the registers beside the operands: 32 with AVX-512, else 16.
constexpr int kMaxSums = kLanes == 16 ? 24 : 12;
constexpr int kMaxSamples = kMaxSums / 2;

// How many panels a tile of so many samples covers: enough sums to hide the latency of an addition.
constexpr int PanelsOfTile(int samples) {
  return 8 * samples <= kMaxSums ? 4 : 4 * samples <= kMaxSums ? 2 : 1;
}

// Small batches wait for the weights to come from beyond the second cache; asked for 2 KB ahead
// they come at nine tenths of the rate at which that can be read at all.
inline void Prefetch(const float* weights) {
  constexpr int kAhead = 512, kLine = 16;
  for (int i = 0; i < kPanelWidth; i += kLine) __builtin_prefetch(weights + kAhead + i);
}

template <int kPanels, int kSamples>
void ComputeTile(const LayerArguments& layer, int panel, int sample) {
  const long panel_size = static_cast<long>(layer.num_inputs) * kPanelWidth;
  const float* weights = layer.weights + panel * panel_size;
  const float* input = layer.input + sample * layer.input_stride;
  Vector sums[kPanels][2][kSamples];
  for (int p = 0; p < kPanels; ++p) {
    for (int half = 0; half < 2; ++half) {
      const Vector bias = Load(layer.bias + (panel + p) * kPanelWidth + half * kLanes);
      for (int s = 0; s < kSamples; ++s) sums[p][half][s] = bias;
    }
  }
  for (int k = 0; k < layer.num_inputs; ++k, weights += kPanelWidth, ++input) {
    for (int p = 0; p < kPanels; ++p) {
      if constexpr (kSamples <= 2) Prefetch(weights + p * panel_size);
      const Vector low = Load(weights + p * panel_size);
      const Vector high = Load(weights + p * panel_size + kLanes);
      for (int s = 0; s < kSamples; ++s) {
        sums[p][0][s] += low * input[s * layer.input_stride];
        sums[p][1][s] += high * input[s * layer.input_stride];
      }
    }
  }
  for (int p = 0; p < kPanels; ++p) {
    for (int half = 0; half < 2; ++half) {
      for (int s = 0; s < kSamples; ++s) {
        Vector value = sums[p][half][s];
        if (layer.nonlinearity == Nonlinearity::kRelu) value = Relu(value);
        if (layer.nonlinearity == Nonlinearity::kTanh) value = Tanh(value);
        Store(value, layer.output + (sample + s) * layer.output_stride + (panel + p) * kPanelWidth +
                         half * kLanes);
      }
    }
  }
}

using Tile = void (*)(const LayerArguments&, int panel, int sample);

// [log2 of panels][samples - 1]
struct Tiles {
  Tile tile[3][kMaxSamples] = {};
};

template <int kSamples>
constexpr void AddTiles(Tiles& tiles) {
  tiles.tile[0][kSamples - 1] = ComputeTile<1, kSamples>;
  if constexpr (PanelsOfTile(kSamples) >= 2) tiles.tile[1][kSamples - 1] = ComputeTile<2, kSamples>;
  if constexpr (PanelsOfTile(kSamples) >= 4) tiles.tile[2][kSamples - 1] = ComputeTile<4, kSamples>;
  if constexpr (kSamples < kMaxSamples) AddTiles<kSamples + 1>(tiles);
}

constexpr Tiles MakeTiles() {
  Tiles tiles;
  AddTiles<1>(tiles);
  return tiles;
}

constexpr Tiles kTiles = MakeTiles();

}  // namespace

// A group of panels stays in the cache while all samples pass it.
void LayerKernel(const LayerArguments& layer) {
  const int rounds = (layer.batch + kMaxSamples - 1) / kMaxSamples;
  const int samples = (layer.batch + rounds - 1) / rounds;
  int log_panels = PanelsOfTile(samples) / 2;  // 4, 2, 1 -> 2, 1, 0
  for (int panel = 0; panel < layer.num_panels; panel += 1 << log_panels) {
    while (panel + (1 << log_panels) > layer.num_panels) --log_panels;
    for (int sample = 0; sample < layer.batch; sample += samples) {
      const int left = layer.batch - sample;
      const int count = left < samples ? left : samples;
      kTiles.tile[log_panels][count - 1](layer, panel, sample);
    }
  }
}

}  // namespace poise::rl::POISE_KERNEL_ISA
