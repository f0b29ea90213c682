#ifndef POISE_CORE_LEARNING_NN_KERNEL_LSTM_KERNEL_H_
#define POISE_CORE_LEARNING_NN_KERNEL_LSTM_KERNEL_H_

/// What an LSTM does between its matrix products, on bare arrays, so that it can be built per
/// instruction set. All arrays are row-major; the quarters of a row of gates are input, forget,
/// cell and output, LibTorch's order. Real: float or double.
namespace poise::learning {

/// One time step of some sequences.
struct LstmStep {
  int rows;    ///< sequences that have this step
  int before;  ///< of them, the first so many had the step before it, too; the others start at zero
  int hidden;
};

template <typename Real>
struct LstmForwardArguments {
  LstmStep step;
  Real* gates;              ///< (rows, 4 hidden) sums; become activations
  const Real* cell_before;  ///< (before, hidden)
  Real* cell;               ///< (rows, hidden)
  Real* squashed;           ///< (rows, hidden) tanh of cell
  Real* output;             ///< (rows, hidden)
};

template <typename Real>
struct LstmBackwardArguments {
  LstmStep step;
  const Real* gates;        ///< (rows, 4 hidden) activations
  const Real* cell_before;  ///< (before, hidden)
  const Real* squashed;     ///< (rows, hidden)
  const Real* output_grad;  ///< (rows, hidden)
  Real*
      cell_grad;  ///< (rows, hidden) of the cell here, from later; becomes that of the cell before
  Real* gates_grad;  ///< (rows, 4 hidden) of the sums
};

namespace isa_v2 {
void LstmForward(const LstmForwardArguments<float>& arguments);
void LstmForward(const LstmForwardArguments<double>& arguments);
void LstmBackward(const LstmBackwardArguments<float>& arguments);
void LstmBackward(const LstmBackwardArguments<double>& arguments);
}  // namespace isa_v2
namespace isa_v3 {
void LstmForward(const LstmForwardArguments<float>& arguments);
void LstmForward(const LstmForwardArguments<double>& arguments);
void LstmBackward(const LstmBackwardArguments<float>& arguments);
void LstmBackward(const LstmBackwardArguments<double>& arguments);
}  // namespace isa_v3
namespace isa_v4 {
void LstmForward(const LstmForwardArguments<float>& arguments);
void LstmForward(const LstmForwardArguments<double>& arguments);
void LstmBackward(const LstmBackwardArguments<float>& arguments);
void LstmBackward(const LstmBackwardArguments<double>& arguments);
}  // namespace isa_v4

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_KERNEL_LSTM_KERNEL_H_
