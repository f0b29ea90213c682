#include "core/learning/nn/lstm.h"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

namespace poise::learning {
namespace {

namespace rnn = torch::nn::utils::rnn;

constexpr int64_t kBatch = 5, kFrames = 7, kInputs = 3, kHidden = 6;

torch::Tensor Lengths() {
  return torch::tensor(std::vector<int64_t>{4, 7, 1, 7, 3}, torch::kInt64);
}

torch::nn::LSTM MakeLstm(bool bidirectional, torch::ScalarType type) {
  torch::manual_seed(3);
  torch::nn::LSTM lstm(
      torch::nn::LSTMOptions(kInputs, kHidden).batch_first(true).bidirectional(bidirectional));
  lstm->to(type);
  return lstm;
}

torch::Tensor ByLibTorch(torch::nn::LSTM& lstm, const torch::Tensor& inputs,
                         const torch::Tensor& lengths) {
  const auto packed = rnn::pack_padded_sequence(inputs, lengths, /*batch_first=*/true,
                                                /*enforce_sorted=*/false);
  const auto outputs = std::get<0>(lstm->forward_with_packed_input(packed));
  return std::get<0>(rnn::pad_packed_sequence(outputs, /*batch_first=*/true, 0, inputs.size(1)));
}

// Gradients of a weighted sum of the outputs with respect to inputs and weights.
std::vector<torch::Tensor> Gradients(const torch::Tensor& outputs, const torch::Tensor& inputs,
                                     const torch::nn::LSTM& lstm) {
  torch::manual_seed(8);
  std::vector<torch::Tensor> of = lstm->parameters();
  of.push_back(inputs);
  return torch::autograd::grad({(outputs * torch::randn_like(outputs)).sum()}, of);
}

void ExpectSameAsLibTorch(bool bidirectional, torch::ScalarType type, double tolerance) {
  torch::nn::LSTM lstm = MakeLstm(bidirectional, type);
  const torch::Tensor inputs = torch::randn({kBatch, kFrames, kInputs}, type).requires_grad_(true);
  const torch::Tensor expected = ByLibTorch(lstm, inputs, Lengths());
  const torch::Tensor outputs = RunLstm(lstm, inputs, Lengths());
  EXPECT_LT((outputs - expected).abs().max().item<double>(), tolerance);
  const auto expected_gradients = Gradients(expected, inputs, lstm);
  const auto gradients = Gradients(outputs, inputs, lstm);
  for (size_t i = 0; i < gradients.size(); ++i) {
    EXPECT_LT((gradients[i] - expected_gradients[i]).abs().max().item<double>(), 10 * tolerance)
        << "gradient " << i;
  }
}

TEST(LstmTest, IsTheOneOfLibTorchInDoublePrecision) {
  ExpectSameAsLibTorch(false, torch::kFloat64, 1e-14);
  ExpectSameAsLibTorch(true, torch::kFloat64, 1e-14);
}

TEST(LstmTest, IsTheOneOfLibTorchInSinglePrecision) {
  ExpectSameAsLibTorch(false, torch::kFloat32, 2e-6);
  ExpectSameAsLibTorch(true, torch::kFloat32, 2e-6);
}

TEST(LstmTest, WithoutLengthsEverySequenceIsWhole) {
  torch::nn::LSTM lstm = MakeLstm(false, torch::kFloat64);
  const torch::Tensor inputs = torch::randn({kBatch, kFrames, kInputs}, torch::kFloat64);
  EXPECT_TRUE(torch::allclose(RunLstm(lstm, inputs), std::get<0>(lstm->forward(inputs))));
}

TEST(LstmTest, FrozenWeightsGetNoGradientAndLetThatOfTheInputsPass) {
  torch::nn::LSTM lstm = MakeLstm(true, torch::kFloat64);
  const torch::Tensor inputs =
      torch::randn({kBatch, kFrames, kInputs}, torch::kFloat64).requires_grad_(true);
  const torch::Tensor expected = Gradients(RunLstm(lstm, inputs, Lengths()), inputs, lstm).back();
  for (torch::Tensor& parameter : lstm->parameters()) parameter.requires_grad_(false);
  const torch::Tensor outputs = RunLstm(lstm, inputs, Lengths());
  torch::manual_seed(8);
  const auto gradient =
      torch::autograd::grad({(outputs * torch::randn_like(outputs)).sum()}, {inputs});
  EXPECT_TRUE(torch::equal(gradient[0], expected));
}

}  // namespace
}  // namespace poise::learning
