#include "core/learning/rl/policy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/base/random.h"
#include "core/base/tensor_file.h"

namespace poise::rl {
namespace {

constexpr int kInputs = 5, kHidden = 7, kOutputs = 3;

Eigen::MatrixXf RandomMatrix(int rows, int columns, base::Random& random) {
  Eigen::MatrixXf matrix(rows, columns);
  for (float& value : matrix.reshaped()) value = static_cast<float>(random.Normal());
  return matrix;
}

struct Parts {
  ObservationScale scale;
  std::vector<LayerWeights> layers;
};

Parts RandomParts() {
  base::Random random(4);
  Parts parts;
  for (int i = 0; i < kInputs; ++i) {
    parts.scale.mean.push_back(static_cast<float>(random.Normal()));
    parts.scale.inverse_deviation.push_back(static_cast<float>(random.Uniform(0.5, 2)));
  }
  parts.scale.limit = 1.5F;
  parts.layers = {{RandomMatrix(kHidden, kInputs, random), RandomMatrix(kHidden, 1, random)},
                  {RandomMatrix(kOutputs, kHidden, random), RandomMatrix(kOutputs, 1, random)}};
  return parts;
}

Policy MakePolicy(const Parts& parts) {
  return Policy(*PolicyNetwork::Create(parts.scale, parts.layers, Activation::kTanh));
}

TEST(PolicyTest, ScalesObservationsThenRunsTheLayers) {
  const Parts parts = RandomParts();
  base::Random random(8);
  const Eigen::VectorXf observation = 3 * RandomMatrix(kInputs, 1, random);
  Eigen::VectorXf values = observation;
  for (int i = 0; i < kInputs; ++i) {
    values[i] = std::clamp(
        (observation[i] - parts.scale.mean[i]) * parts.scale.inverse_deviation[i], -1.5F, 1.5F);
  }
  values = (parts.layers[0].weight * values + parts.layers[0].bias).array().tanh();
  values = parts.layers[1].weight * values + parts.layers[1].bias;
  std::array<float, kOutputs> action;
  MakePolicy(parts).Act({observation.data(), kInputs}, action);
  for (int i = 0; i < kOutputs; ++i) EXPECT_NEAR(action[i], values[i], 1e-5);
}

TEST(PolicyTest, ComesBackFromItsBytesAndActsTheSameInBatches) {
  Policy policy = MakePolicy(RandomParts());
  auto loaded = Policy::Load(policy.Save());
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  base::Random random(9);
  const Eigen::VectorXf observations = RandomMatrix(2 * kInputs, 1, random);
  std::array<float, 2 * kOutputs> both;
  loaded->Act({observations.data(), 2 * kInputs}, 2, both);
  for (int i = 0; i < 2; ++i) {
    std::array<float, kOutputs> one;
    policy.Act({observations.data() + i * kInputs, kInputs}, one);
    for (int j = 0; j < kOutputs; ++j) EXPECT_EQ(one[j], both[i * kOutputs + j]);
  }
}

TEST(PolicyTest, RefusesBytesThatAreNoPolicy) {
  const std::string bytes = MakePolicy(RandomParts()).Save();
  EXPECT_FALSE(Policy::Load("").ok());
  EXPECT_FALSE(Policy::Load(bytes.substr(0, bytes.size() - 4)).ok());
  auto file = base::DecodeTensors(bytes, "test");
  ASSERT_TRUE(file.ok());
  file->tensors.erase("layers.1.bias");
  EXPECT_EQ(base::ErrorReason(Policy::Load(base::EncodeTensors(*file)).status()), "MISSING_TENSOR");
  file = base::DecodeTensors(bytes, "test");
  file->tensors.erase("layers.0.weight");
  EXPECT_FALSE(Policy::Load(base::EncodeTensors(*file)).ok());
  file = base::DecodeTensors(bytes, "test");
  file->metadata.clear();
  EXPECT_EQ(base::ErrorReason(Policy::Load(base::EncodeTensors(*file)).status()),
            "MALFORMED_POLICY");
}

}  // namespace
}  // namespace poise::rl
