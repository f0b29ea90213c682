// A run that is interrupted anywhere ends with the weights of one that was not, bit for bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/learning/nn/module_state.h"
#include "core/learning/nn/trainer.h"

namespace poise::learning {
namespace {

constexpr int64_t kSteps = 60;

// Everything that carries state from step to step: recurrence, dropout, running statistics.
struct Recurrent : torch::nn::Module {
  Recurrent()
      : lstm(register_module("lstm",
                             torch::nn::LSTM(torch::nn::LSTMOptions(4, 8).batch_first(true)))),
        norm(register_module("norm", torch::nn::BatchNorm1d(8))),
        dropout(register_module("dropout", torch::nn::Dropout(0.3))),
        out(register_module("out", torch::nn::Linear(8, 2))) {}
  torch::Tensor forward(const torch::Tensor& x) {
    const torch::Tensor last = std::get<0>(lstm->forward(x)).select(1, x.size(1) - 1);
    return out->forward(dropout->forward(norm->forward(last)));
  }
  torch::nn::LSTM lstm;
  torch::nn::BatchNorm1d norm;
  torch::nn::Dropout dropout;
  torch::nn::Linear out;
};

struct TrainedRun {
  explicit TrainedRun(const std::string& optimizer, uint64_t seed = 7, int64_t steps = kSteps) {
    SeedTorch(seed);
    generator = std::make_shared<Recurrent>();
    critic = std::make_shared<torch::nn::LinearImpl>(2, 1);
    torch::manual_seed(99);  // the data do not depend on the seed
    inputs = torch::randn({40, 6, 4});
    targets = torch::randn({40, 2});
    TrainingSetup setup{.num_samples = 32, .seed = seed};
    const OptimizerConfig config{.type = optimizer,
                                 .learning_rate = 0.01,
                                 .momentum = 0.9,
                                 .warmup_steps = 10,
                                 .schedule = "cosine",
                                 .clip_norm = 0.5};
    setup.networks.push_back({"generator", generator, config,
                              [this](const Batch& batch) { return GeneratorLoss(batch); }});
    setup.networks.push_back(
        {"critic", critic, config, [this](const Batch& batch) { return CriticLoss(batch); }});
    setup.validate = [this]() -> StatusOr<double> {
      const torch::Tensor held_out = torch::arange(32, 40);
      return torch::mse_loss(generator->forward(inputs.index_select(0, held_out)),
                             targets.index_select(0, held_out))
          .item<double>();
    };
    trainer = *Trainer::Create(
        std::move(setup), {.steps = steps, .batch_size = 8, .validate_every = 7, .curve_every = 4});
  }

  StatusOr<Loss> GeneratorLoss(const Batch& batch) {
    const torch::Tensor rows =
        torch::tensor(std::vector<int64_t>(batch.samples.begin(), batch.samples.end()));
    const torch::Tensor noisy =
        inputs.index_select(0, rows) + 0.1 * batch.random.Normal() + 0.1 * torch::randn({8, 6, 4});
    output = generator->forward(noisy);
    const torch::Tensor error = torch::mse_loss(output, targets.index_select(0, rows));
    return Loss{.total = error - 0.1 * critic->forward(output).mean(),
                .terms = {{"error", error.item<double>()}}};
  }
  StatusOr<Loss> CriticLoss(const Batch&) {
    return Loss{.total = torch::relu(1 + critic->forward(output.detach())).mean()};
  }

  // Weights, best weights, optimisers' moments through what follows from them, curve.
  std::string Result() const {
    base::TensorFile file;
    EXPECT_TRUE(AppendState(*generator, "generator/", file).ok());
    EXPECT_TRUE(AppendState(*critic, "critic/", file).ok());
    file.metadata["curve"] = trainer->curve().ToCsv();
    return base::EncodeTensors(file);
  }

  torch::Tensor inputs, targets, output;
  std::shared_ptr<Recurrent> generator;
  std::shared_ptr<torch::nn::LinearImpl> critic;
  std::unique_ptr<Trainer> trainer;
};

// Stops after `steps` more steps: by cancelling from the loss, as a signal could at any time.
std::string InterruptedAt(TrainedRun& run, int64_t step) {
  base::RunContext context;
  std::string checkpoint;
  CheckpointSink sink{.interval = absl::ZeroDuration(),
                      .save = [&](std::string_view bytes, int64_t at) {
                        checkpoint = bytes;
                        if (at == step) context.cancellation.Cancel();
                        return absl::OkStatus();
                      }};
  const auto report = run.trainer->Run(context, sink);
  EXPECT_EQ(report.status().code(), absl::StatusCode::kCancelled) << report.status();
  return checkpoint;
}

class TrainerResumeTest : public testing::TestWithParam<const char*> {};

TEST_P(TrainerResumeTest, FiveInterruptionsChangeNoBit) {
  TrainedRun whole(GetParam());
  ASSERT_TRUE(whole.trainer->Run({}).ok());

  base::Random random(3);
  std::vector<int64_t> moments;
  for (int i = 0; i < 5; ++i)
    moments.push_back(1 + 11 * i + static_cast<int64_t>(random.Index(11)));
  std::string checkpoint;
  for (const int64_t moment : moments) {
    TrainedRun part(GetParam());
    if (!checkpoint.empty()) {
      ASSERT_TRUE(part.trainer->Restore(checkpoint).ok());
    }
    checkpoint = InterruptedAt(part, moment);
  }
  TrainedRun last(GetParam());
  ASSERT_TRUE(last.trainer->Restore(checkpoint).ok());
  const auto report = last.trainer->Run({});
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->steps, kSteps);
  EXPECT_EQ(last.Result(), whole.Result());
}

TEST_P(TrainerResumeTest, AnotherSeedGivesOtherWeights) {
  TrainedRun a(GetParam(), 7), b(GetParam(), 8);
  ASSERT_TRUE(a.trainer->Run({}).ok());
  ASSERT_TRUE(b.trainer->Run({}).ok());
  EXPECT_NE(a.Result(), b.Result());
}

INSTANTIATE_TEST_SUITE_P(Optimizers, TrainerResumeTest, testing::Values("sgd", "adam", "adamw"),
                         [](const auto& test) { return std::string(test.param); });

TEST(TrainerRestoreTest, ACheckpointOfAnotherRunIsRefusedWithTheDifference) {
  TrainedRun run("adam");
  const std::string checkpoint = InterruptedAt(run, 3);
  TrainedRun longer("adam", 7, kSteps + 1);
  const Status status = longer.trainer->Restore(checkpoint);
  EXPECT_EQ(base::ErrorReason(status), "CHECKPOINT_MISMATCH");
  EXPECT_EQ(base::Message(status), "the checkpoint was made with another 'steps': 60, now 61");
  EXPECT_EQ(base::ErrorReason(TrainedRun("adam", 8).trainer->Restore(checkpoint)),
            "CHECKPOINT_MISMATCH");
  EXPECT_EQ(base::ErrorReason(TrainedRun("sgd").trainer->Restore(checkpoint)),
            "CHECKPOINT_MISMATCH");
}

TEST(TrainerRestoreTest, SpoiltCheckpointsAreRefused) {
  TrainedRun run("adam");
  const std::string checkpoint = InterruptedAt(run, 3);
  for (const std::string& bytes : {std::string(), checkpoint.substr(0, checkpoint.size() - 1)}) {
    EXPECT_EQ(base::ErrorReason(TrainedRun("adam").trainer->Restore(bytes)), "CORRUPT_CHECKPOINT");
  }
}

}  // namespace
}  // namespace poise::learning
