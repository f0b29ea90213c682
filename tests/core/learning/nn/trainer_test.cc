#include "core/learning/nn/trainer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/learning/nn/module_state.h"

namespace poise::learning {
namespace {

// One number as a network, so that every update can be computed by hand.
struct Number : torch::nn::Module {
  explicit Number(double start) {
    value = register_parameter("value", torch::tensor({start}, torch::kFloat64));
  }
  double get() const { return value.item<double>(); }
  torch::Tensor value;
};

TrainingSetup Minimise(std::shared_ptr<Number> number, OptimizerConfig optimizer,
                       std::function<torch::Tensor(torch::Tensor)> loss) {
  TrainingSetup setup;
  setup.num_samples = 1;
  setup.networks.push_back({"number", number, optimizer, [=](const Batch&) -> StatusOr<Loss> {
                              return Loss{.total = loss(number->value).sum()};
                            }});
  return setup;
}

TrainingReport Train(TrainingSetup setup, const TrainerConfig& config,
                     const base::RunContext& context = {}) {
  auto trainer = Trainer::Create(std::move(setup), config);
  EXPECT_TRUE(trainer.ok()) << trainer.status();
  auto report = (*trainer)->Run(context);
  EXPECT_TRUE(report.ok()) << report.status();
  return report.value_or(TrainingReport());
}

TEST(TrainerTest, GradientDescentFollowsItsFormula) {
  auto number = std::make_shared<Number>(2.0);
  // x <- x - 0.1 * 2x, three times.
  Train(Minimise(number, {.type = "sgd", .learning_rate = 0.1}, [](auto x) { return x * x; }),
        {.steps = 3});
  EXPECT_NEAR(number->get(), 2 * std::pow(0.8, 3), 1e-12);
}

TEST(TrainerTest, FirstStepOfAdamIsTheRateWhateverTheGradient) {
  for (const double scale : {1e-3, 1e3}) {
    auto number = std::make_shared<Number>(2.0);
    Train(Minimise(number, {.learning_rate = 0.01}, [=](auto x) { return scale * x; }),
          {.steps = 1});
    EXPECT_NEAR(number->get(), 2 - 0.01, 1e-6);
  }
}

TEST(TrainerTest, LongGradientsAreShortenedAndShortOnesKept) {
  for (const auto& [slope, moved] : {std::pair{50.0, 1.0}, std::pair{0.5, 0.5}}) {
    auto number = std::make_shared<Number>(0.0);
    const double factor = slope;
    Train(Minimise(number, {.type = "sgd", .learning_rate = 1, .clip_norm = 1},
                   [=](auto x) { return factor * x; }),
          {.steps = 1});
    EXPECT_NEAR(number->get(), -moved, 1e-6);
  }
}

TEST(TrainerTest, LinearRegressionReachesTheLeastSquaresSolution) {
  SeedTorch(5);
  const torch::Tensor x = torch::randn({64, 3});
  const torch::Tensor y = torch::randn({64, 1});
  const torch::Tensor with_bias = torch::cat({x, torch::ones({64, 1})}, 1);
  const torch::Tensor expected =
      std::get<0>(torch::linalg_lstsq(with_bias, y)).index({torch::indexing::Slice(), 0});
  torch::nn::Linear linear(3, 1);
  TrainingSetup setup{.num_samples = 64};
  setup.networks.push_back(
      {"linear",
       linear.ptr(),
       {.type = "sgd", .learning_rate = 0.2},
       [&](const Batch& batch) -> StatusOr<Loss> {
         const torch::Tensor rows =
             torch::tensor(std::vector<int64_t>(batch.samples.begin(), batch.samples.end()));
         return Loss{.total = torch::mse_loss(linear->forward(x.index_select(0, rows)),
                                              y.index_select(0, rows))};
       }});
  Train(std::move(setup), {.steps = 300, .batch_size = 64});
  for (int64_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(linear->weight[0][i].item<double>(), expected[i].item<double>(), 1e-4);
  }
  EXPECT_NEAR(linear->bias[0].item<double>(), expected[3].item<double>(), 1e-4);
}

TEST(TrainerTest, AdversariesLearnInTurnsFromTheirOwnLossOnly) {
  auto generator = std::make_shared<Number>(1.0), critic = std::make_shared<Number>(3.0);
  TrainingSetup setup{.num_samples = 1};
  const OptimizerConfig sgd{.type = "sgd", .learning_rate = 0.1};
  // The generator's loss has a gradient for the critic too, which must not move it.
  setup.networks.push_back({"generator", generator, sgd, [=](const Batch&) -> StatusOr<Loss> {
                              return Loss{.total = (generator->value * critic->value).sum()};
                            }});
  setup.networks.push_back({"critic", critic, sgd, [=](const Batch&) -> StatusOr<Loss> {
                              return Loss{.total = (critic->value * critic->value).sum()};
                            }});
  Train(std::move(setup), {.steps = 1});
  EXPECT_NEAR(generator->get(), 1 - 0.1 * 3, 1e-12);
  EXPECT_NEAR(critic->get(), 3 - 0.1 * 6, 1e-12);
}

TEST(TrainerTest, EarlyStoppingKeepsTheBestWeights) {
  auto number = std::make_shared<Number>(0.0);
  // Runs up with slope 1, 0.1 a step; held-out data would like 1.
  auto setup = Minimise(number, {.type = "sgd", .learning_rate = 0.1}, [](auto x) { return -x; });
  setup.validate = [=]() -> StatusOr<double> {
    EXPECT_FALSE(number->is_training());
    return std::abs(number->get() - 1);
  };
  const TrainingReport report =
      Train(std::move(setup), {.steps = 1000, .validate_every = 5, .patience = 3});
  EXPECT_EQ(report.stopped_by, "patience");
  EXPECT_EQ(report.best_step, 10);
  EXPECT_EQ(report.steps, 25);
  EXPECT_NEAR(number->get(), 1, 1e-12);
}

TEST(TrainerTest, TheFirstTermThatIsNoNumberIsNamed) {
  auto number = std::make_shared<Number>(1.0);
  TrainingSetup setup{.num_samples = 1};
  setup.networks.push_back({"vae", number, {}, [=](const Batch& batch) -> StatusOr<Loss> {
                              const double kl = batch.step < 7 ? 1 : NAN;
                              return Loss{.total = number->value.sum(), .terms = {{"kl", kl}}};
                            }});
  auto trainer = Trainer::Create(std::move(setup), {.steps = 100});
  ASSERT_TRUE(trainer.ok());
  const auto report = (*trainer)->Run({});
  EXPECT_EQ(report.status().code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(base::ErrorReason(report.status()), "NOT_FINITE");
  EXPECT_EQ(base::Message(report.status()), "network 'vae', step 7: the loss 'kl' is not finite");
}

TEST(TrainerTest, AGradientThatIsNoNumberIsNamedAndTheWeightsStay) {
  auto number = std::make_shared<Number>(0.0);
  // sqrt has a finite value and an infinite slope at 0.
  auto trainer = Trainer::Create(Minimise(number, {}, [](auto x) { return x.sqrt(); }), {});
  ASSERT_TRUE(trainer.ok());
  const auto report = (*trainer)->Run({});
  EXPECT_THAT(base::Message(report.status()),
              testing::HasSubstr("step 0: training: the gradient of 'value' is not finite"));
  EXPECT_EQ(number->get(), 0);
}

TEST(TrainerTest, ProgressTellsLossesAndTheTimeLeft) {
  auto number = std::make_shared<Number>(1.0);
  base::RunContext context;
  std::vector<base::Progress> events;
  context.progress = [&](const base::Progress& progress) { events.push_back(progress); };
  Train(Minimise(number, {}, [](auto x) { return x * x; }), {.steps = 20, .curve_every = 10},
        context);
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back().step, 20);
  EXPECT_EQ(events.back().total, 20);
  EXPECT_GT(events.back().metrics.at("number.loss"), 0);
  EXPECT_EQ(events.back().metrics.at("eta_s"), 0);
}

TEST(TrainerTest, CurveRowsAreMeansOverTheirSteps) {
  auto number = std::make_shared<Number>(4.0);
  // 4, 3, 2, 1: the loss before each step.
  auto trainer = Trainer::Create(
      Minimise(number, {.type = "sgd", .learning_rate = 1}, [](auto x) { return x; }),
      {.steps = 4, .curve_every = 2});
  ASSERT_TRUE(trainer.ok());
  ASSERT_TRUE((*trainer)->Run({}).ok());
  EXPECT_EQ((*trainer)->curve().ToCsv(),
            "step,number.gradient_norm,number.loss\n2,1,3.5\n4,1,1.5\n");
}

TEST(TrainerTest, NothingToLearnIsRefused) {
  EXPECT_EQ(base::ErrorReason(Trainer::Create({}, {}).status()), "NO_NETWORKS");
  TrainingSetup setup = Minimise(std::make_shared<Number>(0.0), {}, [](auto x) { return x; });
  setup.num_samples = 0;
  EXPECT_EQ(base::ErrorReason(Trainer::Create(setup, {}).status()), "NO_SAMPLES");
  setup.num_samples = 1;
  setup.networks[0].optimizer.learning_rate = -1;
  EXPECT_EQ(base::ErrorField(Trainer::Create(setup, {}).status()), "number.learning_rate");
}

}  // namespace
}  // namespace poise::learning
