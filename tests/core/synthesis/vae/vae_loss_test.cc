// Every term of the losses against closed forms, and its gradient against finite differences.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rotation.h"
#include "core/synthesis/vae/vae_loss_net.h"

namespace poise::synthesis {
namespace {

constexpr int64_t kBatch = 2, kFrames = 5, kJoints = 2, kWidth = 3 + 6 * kJoints;
const auto kDouble = torch::TensorOptions().dtype(torch::kFloat64);

torch::Tensor RandomPoses(int64_t seed) {
  torch::manual_seed(seed);
  return torch::randn({kBatch, kFrames, kWidth}, kDouble);
}

torch::Tensor Valid() {
  return ValidFrames(torch::tensor({int64_t{5}, int64_t{3}}), kFrames, kDouble);
}

// The largest difference between autograd's gradient of `loss` at `x` and central differences,
// relative to the largest entry.
double GradientError(const std::function<torch::Tensor(const torch::Tensor&)>& loss,
                     torch::Tensor x) {
  constexpr double kStep = 1e-6;
  x = x.detach().clone().requires_grad_(true);
  loss(x).backward();
  const torch::Tensor gradient = x.grad().clone();
  torch::Tensor numeric = torch::zeros_like(gradient);
  const torch::NoGradGuard no_gradient;
  torch::Tensor flat = x.view(-1), numeric_flat = numeric.view(-1);
  for (int64_t i = 0; i < flat.numel(); ++i) {
    const double value = flat[i].item<double>();
    flat[i] = value + kStep;
    const double up = loss(x).item<double>();
    flat[i] = value - kStep;
    const double down = loss(x).item<double>();
    flat[i] = value;
    numeric_flat[i] = (up - down) / (2 * kStep);
  }
  const double scale = gradient.abs().max().item<double>();
  EXPECT_GT(scale, 0) << "a gradient that is zero everywhere checks nothing";
  return (numeric - gradient).abs().max().item<double>() / scale;
}

// Poses of still motions whose joint `joint` is turned by `angle` about `axis`.
torch::Tensor Turned(double angle, const math::Vec3& axis, int joint) {
  torch::Tensor poses = torch::zeros({1, kFrames, kWidth}, kDouble);
  for (int j = 0; j < kJoints; ++j) {
    const Eigen::Matrix3d r =
        (j == joint ? Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix()
                    : Eigen::Matrix3d::Identity());
    for (int column = 0; column < 2; ++column) {
      for (int row = 0; row < 3; ++row) {
        poses.select(2, 3 + 6 * j + 3 * column + row).fill_(r(row, column));
      }
    }
  }
  return poses;
}

const torch::Tensor kAllValid = torch::ones({1, kFrames}, kDouble);

TEST(VaeLossTest, SixNumbersBecomeTheRotationWhoseColumnsTheyAre) {
  const Eigen::Matrix3d r =
      Eigen::AngleAxisd(0.7, math::Vec3(1, 2, 3).normalized()).toRotationMatrix();
  // Scaled, and the second column leaning: Gram-Schmidt undoes both.
  torch::Tensor poses = Turned(0.7, {1, 2, 3}, 1);
  poses.slice(2, 9, 12).mul_(5);
  poses.slice(2, 12, 15).add_(0.1 * poses.slice(2, 9, 12));
  const torch::Tensor rotations = DecodeColumns(poses).rotations;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR((rotations.index({0, 2, 1, row, column}).item<double>()), r(row, column), 1e-12);
    }
  }
}

TEST(VaeLossTest, ReconstructionIsSquaredDistancePlusFrobenius) {
  // |R_x - R_y|^2 = 4 (1 - cos a) for rotations that differ by the angle a.
  torch::Tensor y = Turned(0.6, {1, -1, 2}, 0);
  y.slice(2, 0, 1).fill_(0.3);
  const torch::Tensor loss =
      ReconstructionLoss(DecodeColumns(Turned(0, {1, 0, 0}, 0)), DecodeColumns(y), kAllValid);
  EXPECT_NEAR(loss.item<double>(), 0.09 + 4 * (1 - std::cos(0.6)), 1e-12);
}

TEST(VaeLossTest, FramesBehindTheEndDoNotCount) {
  const torch::Tensor x = RandomPoses(1);
  torch::Tensor y = RandomPoses(2);
  const auto losses = [&] {
    return torch::stack({ReconstructionLoss(DecodeColumns(x), DecodeColumns(y), Valid()),
                         SmoothnessLoss(DecodeColumns(y), Valid())});
  };
  const torch::Tensor before = losses();
  y.index({1, torch::indexing::Slice(3, 5)}).fill_(9);
  EXPECT_TRUE(torch::allclose(losses(), before));
  y.index({1, 2}).fill_(9);
  EXPECT_FALSE(torch::allclose(losses(), before));
}

TEST(VaeLossTest, SmoothnessOfAParabolaIsItsConstantSecondDifference) {
  torch::Tensor y = Turned(0, {1, 0, 0}, 0);
  for (int64_t t = 0; t < kFrames; ++t) y.index({0, t, 1}).fill_(0.5 * static_cast<double>(t * t));
  EXPECT_NEAR(SmoothnessLoss(DecodeColumns(y), kAllValid).item<double>(), 1, 1e-12);
  EXPECT_EQ(SmoothnessLoss(DecodeColumns(Turned(1, {1, 0, 0}, 0)), kAllValid).item<double>(), 0);
}

TEST(VaeLossTest, KlIsThatOfGaussians) {
  EXPECT_EQ(KlLoss({torch::zeros({3, 4}), torch::zeros({3, 4})}).item<double>(), 0);
  // Half of (m^2 + s^2 - 1 - log s^2) for each of two dimensions.
  const LatentGaussian gaussian{torch::full({1, 2}, 2.0, kDouble),
                                torch::full({1, 2}, std::log(9.0), kDouble)};
  EXPECT_NEAR(KlLoss(gaussian).item<double>(), 4 + 9 - 1 - std::log(9.0), 1e-12);
}

TEST(VaeLossTest, LengthIsComparedMotionByMotion) {
  const torch::Tensor lengths = torch::tensor({int64_t{10}, int64_t{20}});
  EXPECT_EQ(LengthLoss(torch::tensor({10.0, 20.0}), lengths).item<double>(), 0)
      << "the authors' broadcast would give 50";
  EXPECT_EQ(LengthLoss(torch::tensor({13.0, 20.0}), lengths).item<double>(), 4.5);
}

TEST(VaeLossTest, DiscriminatorsWantAMarginOfOne) {
  const torch::Tensor good = torch::tensor({2.0, 1.0});
  EXPECT_EQ(DiscriminatorLoss(good, -good).item<double>(), 0);
  EXPECT_EQ(DiscriminatorLoss(torch::tensor({0.0}), torch::tensor({0.0})).item<double>(), 1);
}

TEST(VaeLossTest, GradientsAreThoseOfFiniteDifferences) {
  const torch::Tensor x = RandomPoses(1), y = RandomPoses(2);
  const auto reconstruction = [&](const torch::Tensor& p) {
    return ReconstructionLoss(DecodeColumns(x), DecodeColumns(p), Valid());
  };
  EXPECT_LT(GradientError(reconstruction, y), 1e-7);
  const auto smoothness = [&](const torch::Tensor& p) {
    return SmoothnessLoss(DecodeColumns(p), Valid());
  };
  EXPECT_LT(GradientError(smoothness, y), 1e-7);

  torch::manual_seed(3);
  const torch::Tensor a = torch::randn({kBatch, 4}, kDouble),
                      b = torch::randn({kBatch, 4}, kDouble);
  EXPECT_LT(GradientError([&](const torch::Tensor& p) { return KlLoss({p, b}); }, a), 1e-7);
  EXPECT_LT(GradientError([&](const torch::Tensor& p) { return KlLoss({a, p}); }, b), 1e-7);
  const torch::Tensor lengths = torch::tensor({int64_t{3}, int64_t{5}});
  EXPECT_LT(GradientError([&](const torch::Tensor& p) { return LengthLoss(p, lengths); },
                          torch::tensor({4.0, 1.5}, kDouble)),
            1e-7);
  const auto real = [&](const torch::Tensor& p) { return DiscriminatorLoss(p, b); };
  EXPECT_LT(GradientError(real, a), 1e-7);
  const auto made = [&](const torch::Tensor& p) { return DiscriminatorLoss(a, p); };
  EXPECT_LT(GradientError(made, b), 1e-7);
}

// Both kinds of layers.
class VaeLayersTest : public ::testing::TestWithParam<const char*> {
 protected:
  VaeNetConfig Small() const {
    return {.layers = GetParam(),
            .latent = 3,
            .hidden = 4,
            .embedding = 5,
            .length_hidden = 3,
            .clock = 2};
  }
};

INSTANTIATE_TEST_SUITE_P(All, VaeLayersTest, ::testing::Values("frames", "lstm"));

TEST_P(VaeLayersTest, GradientsThroughTheNetworksAreThoseOfFiniteDifferences) {
  torch::manual_seed(4);
  const VaeNetConfig small = Small();
  VaeNet net(small, kFrames, kWidth);
  FrameDiscriminator frame(small, kWidth);
  SequenceDiscriminator sequence(small, kFrames, kWidth);
  for (torch::nn::Module* module :
       std::initializer_list<torch::nn::Module*>{&net, &frame, &sequence}) {
    module->to(torch::kFloat64);
  }
  const torch::Tensor lengths = torch::tensor({int64_t{5}, int64_t{3}});
  const auto encoded = [&](const torch::Tensor& p) {
    const LatentGaussian gaussian = net.Encode(p, lengths);
    return KlLoss(gaussian);
  };
  EXPECT_LT(GradientError(encoded, RandomPoses(5)), 1e-6);
  const torch::Tensor x = RandomPoses(6);
  const auto decoded = [&](const torch::Tensor& z) {
    return ReconstructionLoss(DecodeColumns(x), DecodeColumns(net.Decode(z)), Valid()) +
           LengthLoss(net.EstimateLength(z), lengths);
  };
  EXPECT_LT(GradientError(decoded, torch::randn({kBatch, 3}, kDouble)), 1e-6);
  const auto judged = [&](const torch::Tensor& p) {
    return frame.forward(p).mean() + sequence.forward(p, lengths).mean();
  };
  EXPECT_LT(GradientError(judged, RandomPoses(7)), 1e-6);
}

TEST_P(VaeLayersTest, TheFirstPosesAreThoseOfTheWholeMotion) {
  torch::manual_seed(2);
  const VaeNetConfig small = Small();
  VaeNet net(small, kFrames, kWidth);
  const torch::Tensor z = torch::randn({kBatch, 3});
  const torch::Tensor whole = net.Decode(z);
  EXPECT_EQ(whole.size(1), kFrames);
  EXPECT_TRUE(torch::allclose(net.Decode(z, 3), whole.narrow(1, 0, 3), 1e-5, 1e-6));
}

TEST_P(VaeLayersTest, WhatStandsBehindTheEndOfAMotionDoesNotChangeItsCode) {
  torch::manual_seed(4);
  const VaeNetConfig small = Small();
  VaeEncoder encoder(small, kFrames, kWidth);
  SequenceDiscriminator sequence(small, kFrames, kWidth);
  encoder.to(torch::kFloat64);
  sequence.to(torch::kFloat64);
  const torch::Tensor lengths = torch::tensor({int64_t{5}, int64_t{3}});
  // The norm looks at the whole slab, so only values that keep its mean and variance may change.
  torch::Tensor poses = RandomPoses(8);
  torch::Tensor swapped = poses.clone();
  swapped.index({1, 3}).copy_(poses.index({1, 4}));
  swapped.index({1, 4}).copy_(poses.index({1, 3}));
  EXPECT_TRUE(torch::allclose(encoder.forward(poses, lengths).mean,
                              encoder.forward(swapped, lengths).mean));
  EXPECT_TRUE(
      torch::allclose(sequence.forward(poses, lengths), sequence.forward(swapped, lengths)));
  swapped.index({1, 2}).add_(1);
  EXPECT_FALSE(torch::allclose(encoder.forward(poses, lengths).mean,
                               encoder.forward(swapped, lengths).mean));
}

TEST_P(VaeLayersTest, TrainingBeginsAtThePoseAndLengthThatItIsGiven) {
  torch::manual_seed(5);
  VaeNet net(Small(), kFrames, kWidth);
  const torch::Tensor pose = 3 + torch::arange(kWidth, torch::kFloat32), z = torch::zeros({1, 3});
  net.StartAt(torch::zeros({kWidth}), kFrames);
  const torch::Tensor at_zero = net.Decode(z), longest = net.EstimateLength(z);
  net.StartAt(pose, 2);
  EXPECT_TRUE(torch::allclose(net.Decode(z) - at_zero, pose.expand({1, kFrames, kWidth}), 1e-4));
  EXPECT_NEAR((net.EstimateLength(z) - longest).item<double>(), 2 - kFrames, 1e-5);
}

}  // namespace
}  // namespace poise::synthesis
