#include "core/learning/rl/fast_mlp.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace poise::rl {
namespace {

using Sizes = std::vector<int>;

// Scaled so that activations neither die nor saturate.
std::vector<LayerWeights> RandomLayers(const Sizes& sizes, base::Random& random) {
  std::vector<LayerWeights> layers;
  for (size_t i = 0; i + 1 < sizes.size(); ++i) {
    const float scale = std::sqrt(2.0f / sizes[i]);
    const auto draw = [&] { return scale * static_cast<float>(random.Normal()); };
    layers.push_back({Eigen::MatrixXf::NullaryExpr(sizes[i + 1], sizes[i], draw),
                      Eigen::VectorXf::NullaryExpr(sizes[i + 1], draw)});
  }
  return layers;
}

std::vector<float> RandomNumbers(size_t count, base::Random& random) {
  std::vector<float> numbers(count);
  for (float& number : numbers) number = static_cast<float>(random.Normal());
  return numbers;
}

std::vector<float> Outputs(const FastMlp& mlp, const std::vector<float>& input, int batch) {
  FastMlp::Scratch scratch;
  std::vector<float> output(static_cast<size_t>(batch) * mlp.output_size());
  mlp.Forward(input, batch, output, scratch);
  return output;
}

torch::nn::Sequential TorchNet(const std::vector<LayerWeights>& layers, Activation activation) {
  const torch::NoGradGuard no_grad;
  torch::nn::Sequential net;
  for (const auto& [weight, bias] : layers) {
    if (!net->is_empty()) {
      if (activation == Activation::kRelu) net->push_back(torch::nn::ReLU());
      if (activation == Activation::kTanh) net->push_back(torch::nn::Tanh());
    }
    torch::nn::Linear linear(weight.cols(), weight.rows());
    for (Eigen::Index row = 0; row < weight.rows(); ++row) {
      linear->bias[row] = bias[row];
      for (Eigen::Index column = 0; column < weight.cols(); ++column) {
        linear->weight.accessor<float, 2>()[row][column] = weight(row, column);
      }
    }
    net->push_back(linear);
  }
  return net;
}

// Largest difference over the largest output.
double RelativeError(const std::vector<float>& output, const torch::Tensor& expected) {
  const torch::Tensor wanted = expected.contiguous();
  EXPECT_EQ(wanted.numel(), static_cast<int64_t>(output.size()));
  double difference = 0, largest = 0;
  for (size_t i = 0; i < output.size(); ++i) {
    const double value = wanted.data_ptr<float>()[i];
    difference = std::max(difference, std::abs(output[i] - value));
    largest = std::max(largest, std::abs(value));
  }
  return difference / largest;
}

class FastMlpOnIsa : public testing::TestWithParam<base::Isa> {
 protected:
  void SetUp() override {
    if (GetParam() > base::BestIsa()) GTEST_SKIP() << "this CPU lacks the instruction set";
  }
};

TEST_P(FastMlpOnIsa, AgreesWithLibTorchForBatchesAndOddSizes) {
  base::Random random(1);
  for (const Sizes& sizes : {Sizes{200, 1024, 512, 52}, Sizes{1, 1}, Sizes{3, 5, 2},
                             Sizes{17, 33, 65, 31, 1}, Sizes{129, 100, 7}}) {
    for (const Activation activation : {Activation::kRelu, Activation::kTanh}) {
      const auto layers = RandomLayers(sizes, random);
      const FastMlp mlp = *FastMlp::Create(layers, activation, GetParam());
      torch::nn::Sequential net = TorchNet(layers, activation);
      for (int batch = 1; batch <= 17; ++batch) {
        std::vector<float> input = RandomNumbers(batch * sizes.front(), random);
        const torch::NoGradGuard no_grad;
        const torch::Tensor expected =
            net->forward(torch::from_blob(input.data(), {batch, sizes.front()}));
        EXPECT_LT(RelativeError(Outputs(mlp, input, batch), expected), 1e-5)
            << "batch " << batch << ", " << sizes.size() - 1 << " layers from " << sizes.front();
      }
    }
  }
}

TEST_P(FastMlpOnIsa, ASampleIsTheSameToTheBitInEveryBatch) {
  base::Random random(2);
  const FastMlp mlp =
      *FastMlp::Create(RandomLayers({70, 130, 90, 10}, random), Activation::kTanh, GetParam());
  const std::vector<float> input = RandomNumbers(40 * 70, random);
  const std::vector<float> one_by_one = [&] {
    std::vector<float> outputs;
    for (int i = 0; i < 40; ++i) {
      const auto row = Outputs(mlp, {input.begin() + 70 * i, input.begin() + 70 * (i + 1)}, 1);
      outputs.insert(outputs.end(), row.begin(), row.end());
    }
    return outputs;
  }();
  for (int batch = 2; batch <= 40; ++batch) {
    const auto outputs = Outputs(mlp, {input.begin(), input.begin() + 70 * batch}, batch);
    for (size_t i = 0; i < outputs.size(); ++i) {
      ASSERT_EQ(outputs[i], one_by_one[i]) << "batch " << batch << ", output " << i;
    }
  }
}

// A hidden unit per number: tanh alone, undisturbed by sums.
TEST_P(FastMlpOnIsa, TanhIsAccurateFromTheSmallestNumbersToSaturation) {
  std::vector<float> numbers = {0,    1e-38f, 1e-20f, 9,
                                9.1f, 50,     1e30f,  std::numeric_limits<float>::infinity()};
  for (float x = 1e-6f; x < 20; x *= 1.0003f) numbers.push_back(x);
  const int count = static_cast<int>(numbers.size());
  const LayerWeights one = {Eigen::MatrixXf::Ones(1, 1), Eigen::VectorXf::Zero(1)};
  const FastMlp mlp = *FastMlp::Create({one, one}, Activation::kTanh, GetParam());
  const std::vector<float> values = Outputs(mlp, numbers, count);
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double exact = std::tanh(static_cast<double>(numbers[i]));
    EXPECT_LE(std::abs(values[i]), 1);
    if (exact > 0) worst = std::max(worst, std::abs(values[i] - exact) / exact);
    EXPECT_EQ(Outputs(mlp, {-numbers[i]}, 1)[0], -values[i]);
  }
  EXPECT_LT(worst, 3e-7);
  EXPECT_EQ(values[0], 0);
}

TEST_P(FastMlpOnIsa, WhatIsNotANumberStaysSo) {
  const LayerWeights one = {Eigen::MatrixXf::Ones(1, 1), Eigen::VectorXf::Zero(1)};
  for (const Activation activation : {Activation::kRelu, Activation::kTanh}) {
    const FastMlp mlp = *FastMlp::Create({one, one}, activation, GetParam());
    EXPECT_TRUE(std::isnan(Outputs(mlp, {std::nanf("")}, 1)[0]));
  }
}

INSTANTIATE_TEST_SUITE_P(Builds, FastMlpOnIsa,
                         testing::Values(base::Isa::kV2, base::Isa::kV3, base::Isa::kV4),
                         [](const auto& info) {
                           return std::string(base::IsaName(info.param)).substr(7);
                         });

TEST(FastMlpTest, CopiesShareWeightsAndOutliveTheOriginal) {
  base::Random random(3);
  const std::vector<float> input = RandomNumbers(6, random);
  auto original = std::make_unique<FastMlp>(
      *FastMlp::Create(RandomLayers({6, 20, 4}, random), Activation::kRelu));
  const std::vector<float> before = Outputs(*original, input, 1);
  const FastMlp copy = *original;
  original.reset();
  EXPECT_EQ(Outputs(copy, input, 1), before);
  EXPECT_EQ(copy.input_size(), 6);
  EXPECT_EQ(copy.output_size(), 4);
}

TEST(FastMlpTest, LayersThatDoNotFitAreRefusedByName) {
  base::Random random(4);
  const auto expect = [](std::vector<LayerWeights> layers, std::string_view reason,
                         std::string_view field) {
    const auto mlp = FastMlp::Create(layers, Activation::kRelu);
    ASSERT_FALSE(mlp.ok());
    EXPECT_EQ(mlp.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(base::ErrorReason(mlp.status()), reason);
    EXPECT_EQ(base::ErrorField(mlp.status()), field);
  };
  expect({}, "NO_LAYERS", "layers");
  auto layers = RandomLayers({4, 8, 2}, random);
  layers[1].weight = Eigen::MatrixXf::Zero(2, 7);
  expect(layers, "LAYER_SIZE_MISMATCH", "layers[1]");
  layers = RandomLayers({4, 8, 2}, random);
  layers[0].bias = Eigen::VectorXf::Zero(7);
  expect(layers, "LAYER_SIZE_MISMATCH", "layers[0]");
  layers = RandomLayers({4, 8, 2}, random);
  layers[1].weight(0, 0) = std::nanf("");
  expect(layers, "WEIGHT_NOT_FINITE", "layers[1]");
}

}  // namespace
}  // namespace poise::rl
