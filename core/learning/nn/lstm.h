#ifndef POISE_CORE_LEARNING_NN_LSTM_H_
#define POISE_CORE_LEARNING_NN_LSTM_H_

#include <torch/torch.h>

namespace poise::learning {

/// Runs an LSTM of one layer over sequences of different lengths: what LibTorch's module of the
/// same weights gives for packed sequences, with a gradient written out by hand. LibTorch's own
/// records every operation of every time step and adds up the weights' gradient step by step; here
/// a time step is one matrix product and one pass over the gates, and each gradient of the weights
/// is one product over all steps.
/// Shapes:  inputs (batch, frames, inputs) float or double; lengths (batch) int64, each from 1 to
///          frames -> outputs (batch, frames, directions * hidden), zero behind a sequence's end;
///          the second direction begins at each sequence's own end.
/// Not differentiable twice.
torch::Tensor RunLstm(const torch::nn::LSTM& lstm, const torch::Tensor& inputs,
                      const torch::Tensor& lengths);

/// The same for sequences that all have every frame.
torch::Tensor RunLstm(const torch::nn::LSTM& lstm, const torch::Tensor& inputs);

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_LSTM_H_
