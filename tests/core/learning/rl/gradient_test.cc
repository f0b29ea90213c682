// The gradients of the networks and of the policy's loss, which are written by hand, against
// finite differences in double precision.
#include <ATen/ATen.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/learning/rl/surrogate.h"
#include "core/learning/rl/trainable_mlp.h"

namespace poise::rl {
namespace {

constexpr int kBatch = 12, kInputs = 3, kActions = 2;

at::Tensor RandomTensor(std::vector<int64_t> shape, base::Random& random, double scale = 1) {
  const at::Tensor tensor = at::empty(shape, at::kDouble);
  for (int64_t i = 0; i < tensor.numel(); ++i) {
    tensor.data_ptr<double>()[i] = scale * random.Normal();
  }
  return tensor;
}

// Compares `gradient` with central differences of `loss` over each number of `parameters`.
void ExpectGradient(const at::Tensor& parameters, const at::Tensor& gradient,
                    const std::function<double()>& loss) {
  constexpr double kStep = 1e-5;
  ASSERT_EQ(parameters.sizes(), gradient.sizes());
  ASSERT_GT(gradient.abs().max().item<double>(), 1e-4) << "a gradient of 0 proves nothing";
  for (int64_t i = 0; i < parameters.numel(); ++i) {
    double& value = parameters.data_ptr<double>()[i];
    const double kept = value;
    value = kept + kStep;
    const double above = loss();
    value = kept - kStep;
    const double below = loss();
    value = kept;
    ASSERT_NEAR(gradient.contiguous().data_ptr<double>()[i], (above - below) / (2 * kStep), 2e-8)
        << "number " << i;
  }
}

TrainableMlp MakeNetwork(Activation activation, base::Random& random) {
  TrainableMlp network({kInputs, 5, 4, kActions}, activation, kActions, at::kDouble);
  network.Initialize(random, 1);
  network.parameters().add_(RandomTensor({network.parameters().numel()}, random, 0.1));
  return network;
}

class NetworkGradientTest : public testing::TestWithParam<Activation> {};

TEST_P(NetworkGradientTest, EqualsFiniteDifferences) {
  base::Random random(1);
  TrainableMlp network = MakeNetwork(GetParam(), random);
  const at::Tensor inputs = RandomTensor({kBatch, kInputs}, random);
  const at::Tensor weights = RandomTensor({kBatch, kActions}, random);
  EXPECT_TRUE(at::equal(network.Forward(inputs), network.Evaluate(inputs)));
  network.Backward(weights);
  ExpectGradient(network.parameters(), network.gradient().clone(),
                 [&] { return (network.Evaluate(inputs) * weights).sum().item<double>(); });
}

INSTANTIATE_TEST_SUITE_P(Activations, NetworkGradientTest,
                         testing::Values(Activation::kTanh, Activation::kRelu));

// An old policy's batch: its ratios lie inside and outside the clip range on both sides.
SurrogateInput MakeInput(const at::Tensor& means, const at::Tensor& log_deviations,
                         base::Random& random) {
  const at::Tensor noise = RandomTensor({kBatch, kActions}, random);
  const at::Tensor actions = means + noise * log_deviations.exp();
  const at::Tensor log_probs =
      (noise.square() * -0.5 - log_deviations).sum(1) - 0.5 * kActions * std::log(2 * M_PI);
  const at::Tensor weights = at::ones({kBatch}, at::kDouble);
  weights[3] = 0;
  return {.actions = actions,
          .log_probs = log_probs + RandomTensor({kBatch}, random, 0.4),
          .advantages = RandomTensor({kBatch}, random),
          .weights = weights};
}

class SurrogateTest : public testing::Test {
 protected:
  SurrogateTest() {
    config_.entropy_weight = 0.3;
    config_.action_bound = 0.8;
    config_.action_bound_weight = 0.7;
  }
  Surrogate Evaluate() { return EvaluateSurrogate(means_, log_deviations_, input_, config_); }

  base::Random random_{5};
  PpoConfig config_;
  at::Tensor means_ = RandomTensor({kBatch, kActions}, random_);
  at::Tensor log_deviations_ = RandomTensor({kActions}, random_, 0.3);
  SurrogateInput input_ = MakeInput(means_, log_deviations_, random_);
};

TEST_F(SurrogateTest, HasTheGradientOfItsLoss) {
  const Surrogate surrogate = Evaluate();
  ASSERT_GT(surrogate.clip_fraction, 0.2);
  ASSERT_LT(surrogate.clip_fraction, 0.8);
  ExpectGradient(means_, surrogate.means_gradient, [&] { return Evaluate().loss; });
  ExpectGradient(log_deviations_, surrogate.log_deviations_gradient,
                 [&] { return Evaluate().loss; });
}

TEST_F(SurrogateTest, EqualsTheFormulaStepByStep) {
  config_.action_bound = 0;
  double objective = 0, kl = 0, clipped = 0;
  for (int i = 0; i < kBatch; ++i) {
    if (input_.weights[i].item<double>() == 0) continue;
    double log_prob = 0;
    for (int j = 0; j < kActions; ++j) {
      const double deviation = std::exp(log_deviations_[j].item<double>());
      const double score = (input_.actions[i][j] - means_[i][j]).item<double>() / deviation;
      log_prob -= 0.5 * score * score + std::log(deviation * std::sqrt(2 * M_PI));
    }
    const double ratio = std::exp(log_prob - input_.log_probs[i].item<double>());
    const double advantage = input_.advantages[i].item<double>();
    objective += std::min(ratio * advantage, std::clamp(ratio, 0.8, 1.2) * advantage);
    kl += ratio - 1 - std::log(ratio);
    clipped += std::abs(ratio - 1) > 0.2 ? 1 : 0;
  }
  double entropy = 0;
  for (int j = 0; j < kActions; ++j) {
    entropy += log_deviations_[j].item<double>() + 0.5 * std::log(2 * M_PI * M_E);
  }
  const Surrogate surrogate = Evaluate();
  EXPECT_NEAR(surrogate.loss, -objective / (kBatch - 1) - 0.3 * entropy, 1e-12);
  EXPECT_NEAR(surrogate.kl, kl / (kBatch - 1), 1e-12);
  EXPECT_NEAR(surrogate.clip_fraction, clipped / (kBatch - 1), 1e-12);
}

// A quadratic: the first step of Adam has the length of its rate in each number, whatever the
// gradient; a step of descent with momentum is the running sum of gradients.
TEST(OptimizerTest, TakesTheFirstStepsByHand) {
  base::Random random(2);
  for (const char* optimizer : {"adam", "sgd"}) {
    TrainableMlp network = MakeNetwork(Activation::kTanh, random);
    NetworkConfig config;
    config.optimizer = optimizer;
    config.momentum = 0.5;
    const at::Tensor before = network.parameters().clone();
    const at::Tensor inputs = RandomTensor({kBatch, kInputs}, random);
    const at::Tensor weights = RandomTensor({kBatch, kActions}, random);
    network.Forward(inputs);
    network.Backward(weights);
    const at::Tensor first = network.gradient().clone();
    EXPECT_NEAR(network.Step(config, 0.01, 0), first.norm().item<double>(), 1e-12);
    const at::Tensor step = std::string(optimizer) == "adam" ? first.sign() : first;
    EXPECT_TRUE(at::allclose(network.parameters(), before - 0.01 * step, 1e-5, 1e-9)) << optimizer;
    if (std::string(optimizer) == "adam") continue;
    const at::Tensor middle = network.parameters().clone();
    network.Forward(inputs);
    network.Backward(weights);
    const at::Tensor second = network.gradient().clone();
    network.Step(config, 0.01, 0);
    EXPECT_TRUE(at::allclose(network.parameters(), middle - 0.01 * (0.5 * first + second)));
  }
}

TEST(OptimizerTest, CutsLongGradientsAndLetsOnlyWeightsDecay) {
  base::Random random(2);
  TrainableMlp network = MakeNetwork(Activation::kTanh, random);
  NetworkConfig config;
  config.optimizer = "sgd";
  config.weight_decay = 0.1;
  network.Forward(RandomTensor({kBatch, kInputs}, random));
  network.Backward(RandomTensor({kBatch, kActions}, random, 100));
  const at::Tensor gradient = network.gradient().clone();
  const at::Tensor before = network.parameters().clone();
  const double norm = network.Step(config, 1, 2);
  ASSERT_GT(norm, 2);
  const at::Tensor moved = before - network.parameters() - gradient * (2 / norm);
  network.parameters().copy_(moved);  // so that layers() shows what decay did
  const TrainableMlp old = network.Clone();
  old.parameters().copy_(before);
  for (size_t i = 0; i < network.layers().size(); ++i) {
    EXPECT_TRUE(at::allclose(network.layers()[i].weight, 0.1 * old.layers()[i].weight));
    EXPECT_LT(network.layers()[i].bias.abs().max().item<double>(), 1e-12);
  }
  EXPECT_LT(network.tail().abs().max().item<double>(), 1e-12);
}

}  // namespace
}  // namespace poise::rl
