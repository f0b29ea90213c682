// The hip network: what trains is what forecasts, and gradients reach every part of it.
#include <gmock/gmock.h>
#include <torch/torch.h>

#include "core/learning/nn/module_state.h"
#include "core/push/learned/hip_model.h"
#include "core/push/learned/pose_model.h"
#include "core/push/training/hip_net.h"
#include "core/push/training/hip_training.h"
#include "core/push/training/pose_training.h"
#include "core/push/training/train_push.h"
#include "tests/core/push/fzj_data.h"

namespace poise::push {
namespace {

using torch::Tensor;

MatrixXf ToMatrix(const Tensor& tensor) {
  const Tensor flat = tensor.to(torch::kFloat32).contiguous();
  return Eigen::Map<const MatrixXf>(flat.data_ptr<float>(), flat.size(0), flat.size(1));
}

// Four people in a line within reach of each other; the first is pushed.
TakeBatch LineBatch(int64_t frames) {
  const int64_t people = 4;
  TakeBatch batch{.hip = torch::zeros({1, people, frames, 2}),
                  .lean = torch::zeros({1, people, frames, 2}),
                  .place = torch::zeros({1, people, 2}),
                  .push = torch::zeros({1, people, frames, 2}),
                  .context = 0.3 * torch::randn({1, people, kContextSize}),
                  .mask = torch::ones({1, people, frames})};
  for (int64_t i = 0; i < people; ++i) batch.place[0][i][0] = 0.5 * static_cast<double>(i);
  batch.push.slice(1, 0, 1).slice(2, 0, 10).fill_(0.4);
  return batch;
}

TakeBatch InDouble(TakeBatch batch) {
  for (Tensor* tensor :
       {&batch.hip, &batch.lean, &batch.place, &batch.push, &batch.context, &batch.mask}) {
    *tensor = tensor->to(torch::kFloat64);
  }
  return batch;
}

std::vector<Pair> PairsWithin(const MatrixXf& places, double reach) {
  NeighbourPairs neighbours;
  return neighbours.Find(places.cast<double>().array(), reach);
}

TEST(LearnedHipTest, ForecastsAreTheTrainedNetworksToAMillionth) {
  torch::NoGradGuard no_gradient;
  torch::manual_seed(1);
  const HipConfig config;
  HipNet net(config);
  constexpr int64_t kFrames = 60;
  base::TensorFile file;
  ASSERT_TRUE(learning::AppendState(*net, "hip.0.", file).ok());
  // In double precision, so that a difference is the forecaster's own rounding.
  net->to(torch::kFloat64);
  const TakeBatch batch = InDouble(LineBatch(kFrames));
  const HipPaths expected = net->Rollout(batch, kFrames);
  ASSERT_GT((expected.hip[0][3][kFrames - 1]).abs().max().item<double>(), 1e-3);

  const auto model = HipModel::Read(file, "hip.0.", config);
  ASSERT_TRUE(model.ok()) << model.status();
  HipStates states = HipStates::Standing(4, config.hidden);
  HipInfluence influence = HipInfluence::None(4);
  influence.place = ToMatrix(batch.place[0]);
  influence.context = ToMatrix(batch.context[0]);
  for (int64_t frame = 0; frame + 1 < kFrames; ++frame) {
    influence.push = ToMatrix(batch.push[0].select(1, frame)) / static_cast<float>(kPushScale);
    model->Step(influence, PairsWithin(influence.place + states.hip, config.reach_m), states);
    const MatrixXf hip = ToMatrix(expected.hip[0].select(1, frame + 1));
    const MatrixXf lean = ToMatrix(expected.lean[0].select(1, frame + 1));
    ASSERT_LT((states.hip - hip).cwiseAbs().maxCoeff(), 1e-6) << frame;
    ASSERT_LT((states.lean - lean).cwiseAbs().maxCoeff(), 1e-6) << frame;
  }
}

TEST(LearnedHipTest, GradientsOfTheInteractionAreFiniteDifferences) {
  torch::manual_seed(2);
  HipNet net(HipConfig{.hidden = 8, .message = 4, .message_hidden = 6});
  net->to(torch::kFloat64);
  const TakeBatch batch = InDouble(LineBatch(20));
  // How far the one ahead of the pushed person comes: only messages move it by the push.
  const auto travel = [&] { return net->Rollout(batch, 20).hip[0][1][19].sum(); };
  travel().backward();
  for (const char* name : {"message_in.weight", "message_out.weight"}) {
    Tensor weight = net->named_parameters()[name];
    const Tensor gradient = weight.grad().clone();
    EXPECT_GT(gradient.abs().max().item<double>(), 1e-9) << name;
    torch::NoGradGuard no_gradient;
    constexpr double kStep = 1e-5;
    for (const auto& [row, column] : {std::pair(0, 0), std::pair(1, 3), std::pair(2, 4)}) {
      const double before = weight[row][column].item<double>();
      weight[row][column] = before + kStep;
      const double more = travel().item<double>();
      weight[row][column] = before - kStep;
      const double less = travel().item<double>();
      weight[row][column] = before;
      const double slope = (more - less) / (2 * kStep);
      EXPECT_NEAR(gradient[row][column].item<double>(), slope, 1e-6 * std::abs(slope) + 1e-11)
          << name << " " << row << " " << column;
    }
  }
}

TEST(LearnedHipTest, PosesAreTheTrainedNetworksToAMillionth) {
  torch::NoGradGuard no_gradient;
  torch::manual_seed(3);
  const PoseConfig config{.lookahead = 4};
  PoseNet net(config);
  PoseBatch batch{.hip = torch::randn({3, 34, 2}).cumsum(1) * 0.01,
                  .lean = torch::zeros({3, 30, 2}),
                  .body = torch::randn({3, kBodySize}),
                  .joints = torch::zeros({3, 30, kBodyJoints, 3}),
                  .height = torch::zeros({3, 30}),
                  .swings = {},
                  .footholds = {},
                  .foothold_known = {},
                  .mask = torch::ones({3, 30})};
  const Tensor expected = net->Forward(batch).height;
  const Tensor path = PathFeatures(batch, config);
  base::TensorFile file;
  ASSERT_TRUE(learning::AppendState(*net, "", file).ok());
  const auto model = PoseModel::Read(file, "", config);
  ASSERT_TRUE(model.ok()) << model.status();
  MatrixXf memory = MatrixXf::Zero(3, config.hidden);
  for (int64_t frame = 0; frame < 30; ++frame) {
    const MatrixXf pose =
        model->Step(ToMatrix(path.select(1, frame)), ToMatrix(batch.body), memory);
    for (int person = 0; person < 3; ++person) {
      ASSERT_NEAR(pose(person, kHeightColumn), expected[person][frame].item<float>(), 1e-6);
    }
  }
}

TEST(LearnedHipTest, AFewStepsOnOneTakeBringItsHipNearer) {
  POISE_REQUIRE_DATA("fzj_push");
  const PushTake& take = testing::TakeNamed("X05", 0);
  const TrainingTakes takes{{&take}, {&take}};
  base::RunContext context;
  context.seed = 1;
  const auto trained = TrainHip(takes, Protocol::kB, {},
                                {.network = {.steps = 60, .batch_size = 1, .validate_every = 20},
                                 .still_share = 0,
                                 .mirror = false},
                                context);
  ASSERT_TRUE(trained.ok()) << trained.status();
  base::Random random(1);
  const TakeBatch batch = MakeBatch(takes.train, Protocol::kB, {}, random);
  const double standing = batch.hip.square().sum(-1).sqrt().mean().item<double>();
  EXPECT_LT(trained->report.best_validation, 0.5 * standing);
}

TEST(LearnedHipTest, AMirroredTakeIsTheSameTakeFromTheOtherSide) {
  POISE_REQUIRE_DATA("fzj_push");
  const PushTake& take = testing::TakeNamed("group_1", 0);
  const std::vector<const PushTake*> takes(8, &take);
  base::Random random(4);
  const TakeBatch batch = MakeBatch(takes, Protocol::kA, {.mirror = true}, random);
  const Tensor sides = batch.place.select(1, 1).select(1, 1).sign();
  EXPECT_LT(sides.min().item<double>(), sides.max().item<double>());  // both occur
  const Tensor side = sides.reshape({8, 1, 1});
  EXPECT_LT((batch.hip.select(-1, 1) * side - batch.hip.select(-1, 1)[0] * side[0])
                .abs()
                .max()
                .item<double>(),
            1e-6);
}

TEST(PoseTrainingTest, FeetSwingInStepsAndStandElsewhere) {
  POISE_REQUIRE_DATA("fzj_push");
  const PushTake& take = testing::TakeNamed("X05", 8);
  const PoseBatch batch = MakePoseBatch(PeopleOf({&take}), 4, {}, {}, nullptr);
  const TakePerson& person = take.people[0];
  int swinging = 0;
  for (int frame = 0; frame + 1 < take.frames; ++frame) {
    for (int foot = 0; foot < 2; ++foot) {
      const auto place = [&](int at) -> Eigen::Vector2d {
        return Eigen::Vector2d(batch.footholds[0][at][foot][0].item<double>(),
                               batch.footholds[0][at][foot][1].item<double>()) +
               person.joint(at, kPelvis).head<2>();
      };
      const Eigen::Vector2d toe = person.joint(frame, kToes[foot]).head<2>();
      if (batch.swings[0][frame][foot].item<double>() < 0.5) {
        ASSERT_LT((place(frame) - toe).norm(), 1e-6);
      } else {
        ++swinging;
        // The same place until it is reached.
        ASSERT_LT((place(frame) - place(frame + 1)).norm(), 1e-6) << frame;
      }
    }
  }
  EXPECT_GT(swinging, 20);
}

TEST(PoseTrainingTest, BodiesLearnOnForecastHipsWhereThereAreSome) {
  POISE_REQUIRE_DATA("fzj_push");
  const PushTake& one = testing::TakeNamed("X05", 0);
  const PushTake& other = testing::TakeNamed("X05", 2);
  constexpr int kAhead = 4;
  const auto size = [&](double value) { return torch::full({1, one.frames + kAhead, 2}, value); };
  const HipForecasts forecasts{{&one, {size(0.3), size(0.1)}}};
  const PoseBatch batch = MakePoseBatch(PeopleOf({&one, &other}), kAhead, {}, forecasts, nullptr);
  EXPECT_FLOAT_EQ(batch.hip[0][one.frames + kAhead - 1][1].item<float>(), 0.3f);
  EXPECT_FLOAT_EQ(batch.lean[0][7][0].item<float>(), 0.1f);
  const double recorded =
      other.people[0].joint(9, kPelvis).x() - other.people[0].joint(0, kPelvis).x();
  EXPECT_FLOAT_EQ(batch.hip[1][9][0].item<float>(), static_cast<float>(recorded));
}

TEST(TrainPushTest, AnInterruptedTrainingEndsWithTheSameWeights) {
  POISE_REQUIRE_DATA("fzj_push");
  std::vector<PushTake> takes;
  for (const PushTake& take : testing::SingleTakes()) {
    if (take.group == "X05") takes.push_back(take);
  }
  PushTraining config;
  config.hip_members = 2;
  config.pose_members = 1;
  config.hip = {.hidden = 8, .message = 4, .message_hidden = 4};
  config.pose = {.hidden = 8};
  config.hip_training.network = {.steps = 4, .batch_size = 2, .validate_every = 2};
  config.pose_training.network = {.steps = 4, .batch_size = 2, .validate_every = 2};
  base::RunContext context;
  context.seed = 3;
  const PushTask task{.takes = takes, .config = config};
  const auto whole = TrainPush(task, context);
  ASSERT_TRUE(whole.ok()) << whole.status();
  // Stopped in the second member: it hands over a checkpoint.
  std::string checkpoint;
  base::RunContext stopped = context;
  stopped.cancellation = base::CancellationToken();
  stopped.progress = [&](const base::Progress& progress) {
    if (progress.step >= 6) stopped.cancellation.Cancel();
  };
  const learning::CheckpointSink sink{absl::ZeroDuration(), [&](std::string_view bytes, int64_t) {
                                        checkpoint = bytes;
                                        return absl::OkStatus();
                                      }};
  EXPECT_TRUE(absl::IsCancelled(TrainPush(task, stopped, {}, sink).status()));
  ASSERT_FALSE(checkpoint.empty());
  const auto resumed = TrainPush(task, context, checkpoint);
  ASSERT_TRUE(resumed.ok()) << resumed.status();
  EXPECT_EQ(resumed->model.card.weights_sha256, whole->model.card.weights_sha256);
  EXPECT_EQ(resumed->model.card.scores, whole->model.card.scores);
  EXPECT_EQ(base::ErrorReason(TrainPush(task, context, "nonsense").status()), "CORRUPT_CHECKPOINT");
}

}  // namespace
}  // namespace poise::push
