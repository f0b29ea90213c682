#include "core/learning/nn/module_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <new>
#include <stdexcept>

#include "core/learning/nn/guard.h"
#include "core/learning/nn/trainer.h"

namespace poise::learning {
namespace {

torch::nn::Sequential MakeNetwork(int64_t hidden = 5) {
  return torch::nn::Sequential(torch::nn::Linear(3, hidden), torch::nn::BatchNorm1d(hidden),
                               torch::nn::Linear(hidden, 2));
}

TEST(ModuleStateTest, ANetworkRebuiltFromBytesGivesTheSameOutputs) {
  SeedTorch(1);
  auto network = MakeNetwork();
  network->forward(torch::randn({8, 3}));  // moves the running statistics of the batch norm
  base::TensorFile file;
  ASSERT_TRUE(AppendState(*network, "net/", file).ok());
  const auto read = base::DecodeTensors(base::EncodeTensors(file), "weights");
  ASSERT_TRUE(read.ok()) << read.status();
  SeedTorch(2);
  auto rebuilt = MakeNetwork();
  ASSERT_TRUE(LoadState(*read, "net/", *rebuilt).ok());
  network->eval();
  rebuilt->eval();
  const torch::Tensor input = torch::randn({4, 3});
  EXPECT_TRUE(torch::equal(network->forward(input), rebuilt->forward(input)));
}

TEST(ModuleStateTest, EigenReadsTheWeightsOfALinearLayer) {
  SeedTorch(1);
  torch::nn::Linear linear(3, 2);
  base::TensorFile file;
  ASSERT_TRUE(AppendState(*linear, "", file).ok());
  const auto weight = file.Floats("weight", std::vector<int64_t>{2, 3});
  const auto bias = file.Floats("bias", std::vector<int64_t>{2});
  ASSERT_TRUE(weight.ok() && bias.ok());
  using RowMajor = Eigen::Matrix<float, 2, 3, Eigen::RowMajor>;
  const Eigen::Vector2f output =
      Eigen::Map<const RowMajor>(weight->data()) * Eigen::Vector3f(1, -2, 3) +
      Eigen::Map<const Eigen::Vector2f>(bias->data());
  const torch::Tensor expected = linear->forward(torch::tensor({1.f, -2.f, 3.f}));
  EXPECT_NEAR(output[0], expected[0].item<float>(), 1e-6);
  EXPECT_NEAR(output[1], expected[1].item<float>(), 1e-6);
}

TEST(ModuleStateTest, WhatDoesNotFitIsNamed) {
  base::TensorFile file;
  ASSERT_TRUE(AppendState(*MakeNetwork(5), "net/", file).ok());
  auto wider = MakeNetwork(6);
  const Status wrong = LoadState(file, "net/", *wider);
  EXPECT_EQ(base::ErrorReason(wrong), "WRONG_SHAPE");
  EXPECT_EQ(base::Message(wrong),
            "tensor 'net/0.weight' is F32 (5, 3), the network has Float (6, 3)");
  torch::nn::Sequential shallow{torch::nn::Linear(3, 5)};
  EXPECT_EQ(base::ErrorReason(LoadState(file, "net/", *shallow)), "UNKNOWN_TENSOR");
  EXPECT_EQ(base::ErrorReason(LoadState(file, "other/", *shallow)), "MISSING_TENSOR");
}

TEST(ModuleStateTest, ANotFiniteWeightIsNamed) {
  auto network = MakeNetwork();
  EXPECT_TRUE(CheckFinite(*network, "vae").ok());
  {
    const torch::NoGradGuard no_gradient;
    network->named_parameters()["2.bias"][1] = NAN;
  }
  EXPECT_EQ(base::Message(CheckFinite(*network, "vae")), "vae: tensor '2.bias' is not finite");
}

TEST(GuardTest, ExceptionsOfLibTorchBecomeStatusesOfOneLine) {
  const auto result = Guard("decode", []() -> StatusOr<torch::Tensor> {
    return torch::mm(torch::zeros({2, 3}), torch::zeros({2, 3}));
  });
  EXPECT_EQ(base::ErrorReason(result.status()), "NETWORK_FAILED");
  EXPECT_THAT(base::Message(result.status()),
              testing::AllOf(testing::HasSubstr("decode: "), testing::HasSubstr("2x3"),
                             testing::Not(testing::HasSubstr("\n"))));
}

TEST(GuardTest, LackOfMemoryAndOtherExceptionsAreToldApart) {
  EXPECT_EQ(base::ErrorReason(Guard("x", []() -> Status { throw std::bad_alloc(); })),
            "OUT_OF_MEMORY");
  EXPECT_EQ(base::ErrorReason(Guard("x", []() -> Status { throw std::runtime_error("no"); })),
            "NETWORK_FAILED");
  EXPECT_EQ(Guard("x", []() -> StatusOr<int> { return 3; }).value(), 3);
  EXPECT_EQ(Guard("x", []() -> StatusOr<int> { return absl::AbortedError("a"); }).status(),
            absl::AbortedError("a"));
}

}  // namespace
}  // namespace poise::learning
