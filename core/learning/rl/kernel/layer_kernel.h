#ifndef POISE_CORE_LEARNING_RL_KERNEL_LAYER_KERNEL_H_
#define POISE_CORE_LEARNING_RL_KERNEL_LAYER_KERNEL_H_

/// One fully connected layer on bare arrays, so that it can be built per instruction set.
namespace poise::rl {

enum class Nonlinearity { kNone, kRelu, kTanh };

/// Outputs are taken in panels of kPanelWidth, which depends on the build. Weights are stored in
/// the order in which they are read: panel by panel, and in a panel input by input.
struct LayerArguments {
  int num_inputs;
  int num_panels;
  const float* weights;  ///< (panels, inputs, panel width), 0 beyond the last output; 64 B aligned
  const float* bias;     ///< (panels, panel width), likewise
  Nonlinearity nonlinearity;
  int batch;
  const float* input;  ///< (batch, inputs), rows `input_stride` apart
  long input_stride;
  float* output;       ///< (batch, panels, panel width), 64 B aligned
  long output_stride;  ///< a multiple of the panel width
};

/// A sample's outputs are the same to the bit in every batch: each is summed in the order of the
/// inputs. Activations: relu; tanh to 3e-7 relative. NaN stays NaN.
namespace isa_v2 {
inline constexpr int kPanelWidth = 8;
void LayerKernel(const LayerArguments& arguments);
}  // namespace isa_v2
namespace isa_v3 {
inline constexpr int kPanelWidth = 16;
void LayerKernel(const LayerArguments& arguments);
}  // namespace isa_v3
namespace isa_v4 {
inline constexpr int kPanelWidth = 32;
void LayerKernel(const LayerArguments& arguments);
}  // namespace isa_v4

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_KERNEL_LAYER_KERNEL_H_
