#include "core/learning/nn/kernel/lstm_kernel.h"

// GCC 12 takes the operand that AVX-512 intrinsics leave unset for a variable in use.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <Eigen/Core>

namespace poise::learning::POISE_KERNEL_ISA {
namespace {

template <typename Real>
using Values = Eigen::Map<Eigen::Array<Real, Eigen::Dynamic, 1>>;
template <typename Real>
using ConstValues = Eigen::Map<const Eigen::Array<Real, Eigen::Dynamic, 1>>;

enum Gate { kInput, kForget, kCell, kOutput };

// sigmoid x = (1 + tanh(x / 2)) / 2
template <typename Real>
void Squash(Values<Real> gate) {
  constexpr Real kHalf = 0.5;
  gate = (gate * kHalf).tanh() * kHalf + kHalf;
}

template <typename Real>
void Forward(const LstmForwardArguments<Real>& a) {
  const int hidden = a.step.hidden;
  for (long row = 0; row < a.step.rows; ++row) {
    Real* gates = a.gates + row * 4 * hidden;
    const auto gate = [&](Gate which) { return Values<Real>(gates + which * hidden, hidden); };
    Squash<Real>(gate(kInput));
    Squash<Real>(gate(kForget));
    gate(kCell) = gate(kCell).tanh();
    Squash<Real>(gate(kOutput));
    Values<Real> cell(a.cell + row * hidden, hidden);
    cell = gate(kInput) * gate(kCell);
    if (row < a.step.before) {
      cell += gate(kForget) * ConstValues<Real>(a.cell_before + row * hidden, hidden);
    }
    Values<Real> squashed(a.squashed + row * hidden, hidden);
    squashed = cell.tanh();
    Values<Real>(a.output + row * hidden, hidden) = gate(kOutput) * squashed;
  }
}

template <typename Real>
void Backward(const LstmBackwardArguments<Real>& a) {
  const int hidden = a.step.hidden;
  for (long row = 0; row < a.step.rows; ++row) {
    const auto gate = [&](Gate which) {
      return ConstValues<Real>(a.gates + (row * 4 + which) * hidden, hidden);
    };
    const auto grad = [&](Gate which) {
      return Values<Real>(a.gates_grad + (row * 4 + which) * hidden, hidden);
    };
    const ConstValues<Real> squashed(a.squashed + row * hidden, hidden);
    const ConstValues<Real> output_grad(a.output_grad + row * hidden, hidden);
    Values<Real> cell_grad(a.cell_grad + row * hidden, hidden);
    cell_grad += output_grad * gate(kOutput) * (1 - squashed.square());
    grad(kInput) = cell_grad * gate(kCell) * gate(kInput) * (1 - gate(kInput));
    grad(kCell) = cell_grad * gate(kInput) * (1 - gate(kCell).square());
    grad(kOutput) = output_grad * squashed * gate(kOutput) * (1 - gate(kOutput));
    if (row < a.step.before) {
      grad(kForget) = cell_grad * ConstValues<Real>(a.cell_before + row * hidden, hidden) *
                      gate(kForget) * (1 - gate(kForget));
    } else {
      grad(kForget).setZero();
    }
    cell_grad *= gate(kForget);
  }
}

}  // namespace

void LstmForward(const LstmForwardArguments<float>& arguments) { Forward(arguments); }
void LstmForward(const LstmForwardArguments<double>& arguments) { Forward(arguments); }
void LstmBackward(const LstmBackwardArguments<float>& arguments) { Backward(arguments); }
void LstmBackward(const LstmBackwardArguments<double>& arguments) { Backward(arguments); }

}  // namespace poise::learning::POISE_KERNEL_ISA
