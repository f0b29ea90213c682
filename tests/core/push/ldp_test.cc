// The paper's method: its equations against core/push/pendulum and written-out values, gradients
// against finite differences, and a training from end to end.
#include <gmock/gmock.h>
#include <torch/torch.h>

#include "core/base/random.h"
#include "core/push/evaluation/evaluate_push.h"
#include "core/push/ldp/forecast_ldp.h"
#include "core/push/ldp/ldp_net.h"
#include "core/push/ldp/ldp_tasks.h"
#include "core/push/ldp/train_ldp.h"
#include "core/push/presets/check_preset.h"
#include "tests/core/push/fzj_data.h"

namespace poise::push::ldp {
namespace {

using torch::Tensor;

constexpr auto kDouble = torch::kFloat64;

Tensor ToTensor(const PendulumArray& array) {
  const Eigen::Array<double, Eigen::Dynamic, 4, Eigen::RowMajor> rows = array;
  return torch::from_blob(const_cast<double*>(rows.data()), {rows.rows(), 4}, kDouble).clone();
}
Tensor ToTensor(const PersonArray& array) {
  return torch::from_blob(const_cast<double*>(array.data()), {array.size()}, kDouble).clone();
}

// Pendulums that lean and move, and forces on them.
struct Sample {
  PendulumStates states;
  PersonArray mass, height;
  PendulumArray force;
  PendulumTensors tensors() const {
    return {ToTensor(states.position), ToTensor(states.velocity), ToTensor(states.rod)};
  }
};
Sample RandomSample(int people) {
  base::Random random(5);
  Sample sample{{PendulumArray(people, 4), PendulumArray(people, 4), PersonArray(people)},
                PersonArray(people),
                PersonArray(people),
                PendulumArray(people, 4)};
  for (int i = 0; i < people; ++i) {
    for (int axis = 0; axis < 4; ++axis) {
      sample.states.position(i, axis) = 0.3 * random.Normal();
      sample.states.velocity(i, axis) = random.Normal();
      sample.force(i, axis) = 200 * random.Normal();
    }
    sample.states.rod[i] = random.Uniform(0.8, 1.1);
    sample.mass[i] = random.Uniform(60, 120);
    sample.height[i] = 0.1;
  }
  return sample;
}

TEST(LdpPendulumTest, EquationsAreThoseOfThePendulum) {
  const Sample sample = RandomSample(50);
  const PendulumTensors states = sample.tensors();
  const auto worst = [](const Tensor& a, const Tensor& b) {
    return (a - b).abs().max().item<double>();
  };
  EXPECT_LT(worst(Accelerations(states, ToTensor(sample.mass), ToTensor(sample.force)),
                  ToTensor(Accelerations(sample.states, sample.mass, sample.force))),
            1e-9);
  const Eigen::ArrayX3d ends = push::RodEnds(sample.states, sample.height);
  const Tensor found = RodEnds(states.position, states.rod, ToTensor(sample.height));
  const PendulumArray at_end =
      AtRod(sample.states, sample.force.leftCols(2), PersonArray::Ones(50));
  EXPECT_LT(worst(AtRodEnd(states, ToTensor(sample.force).slice(1, 0, 2)), ToTensor(at_end)), 1e-9);
  for (int i = 0; i < 50; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(found[i][axis].item<double>(), ends(i, axis), 1e-12);
    }
  }
}

TEST(LdpPendulumTest, GradientsOfAccelerationsAreFiniteDifferences) {
  const Sample sample = RandomSample(3);
  PendulumTensors states = sample.tensors();
  const Tensor mass = ToTensor(sample.mass), force = ToTensor(sample.force);
  const auto sum = [&] { return Accelerations(states, mass, force).square().sum(); };
  for (Tensor* input : {&states.position, &states.velocity, &states.rod}) {
    input->requires_grad_();
    sum().backward();
    const Tensor gradient = input->grad().reshape({-1});
    input->requires_grad_(false);
    Tensor values = input->view({-1});
    for (int64_t i = 0; i < values.numel(); ++i) {
      constexpr double kStep = 1e-6;
      const double before = values[i].item<double>();
      values[i] = before + kStep;
      const double more = sum().item<double>();
      values[i] = before - kStep;
      const double less = sum().item<double>();
      values[i] = before;
      const double slope = (more - less) / (2 * kStep);
      ASSERT_NEAR(gradient[i].item<double>(), slope, 1e-5 * std::abs(slope) + 1e-4);
    }
  }
}

PairTensors OnePair(std::array<double, 4> own, std::array<double, 4> other,
                    std::array<double, 4> own_rate = {}, std::array<double, 4> other_rate = {}) {
  const auto row = [](const std::array<double, 4>& values) {
    return torch::tensor(torch::ArrayRef<double>(values.data(), 4), kDouble).reshape({1, 4});
  };
  const Tensor rod = torch::ones({1}, kDouble);
  return {{row(own), row(own_rate), rod}, {row(other), row(other_rate), rod}};
}

TEST(LdpInteractionTest, ThePotentialsForceIsItsSlope) {
  const InteractionConfig config;
  const auto potential = [&](double x, double y) {  // of r = own - other, v = other - own
    const double vx = -0.7, vy = 0.4, dt = 1.0 / 60;
    const double both = std::hypot(x, y) + std::hypot(x - vx * dt, y - vy * dt);
    const double b = 0.5 * std::sqrt(both * both - std::pow(std::hypot(vx, vy) * dt, 2));
    return config.potential * std::exp(-b / config.potential_m);
  };
  const double x = -0.3, y = 0.1, step = 1e-6;
  const Tensor force = PotentialForce(OnePair({x, y, 0, 0}, {}, {0.7, -0.4, 0, 0}), config)[0];
  EXPECT_NEAR(force[0].item<double>(),
              -(potential(x + step, y) - potential(x - step, y)) / (2 * step), 1e-6);
  EXPECT_NEAR(force[1].item<double>(),
              -(potential(x, y + step) - potential(x, y - step)) / (2 * step), 1e-6);
}

TEST(LdpInteractionTest, AngularSignsAreThePapersTable) {
  // Rows: own lean positive, zero, negative; columns: the neighbour's. Reference sec. 5.3.
  constexpr int kThetaBehind[3][3] = {{1, 0, 0}, {1, 0, 0}, {1, 1, 1}};
  constexpr int kThetaAhead[3][3] = {{-1, -1, -1}, {0, 0, -1}, {0, 0, -1}};
  constexpr int kPhiBehind[3][3] = {{-1, -1, -1}, {0, 0, -1}, {0, 0, -1}};
  constexpr int kPhiAhead[3][3] = {{1, 0, 0}, {1, 0, 0}, {1, 1, 1}};
  constexpr double kLeans[] = {0.2, 0, -0.2};
  for (int own = 0; own < 3; ++own) {
    for (int other = 0; other < 3; ++other) {
      for (const double side : {1.0, -1.0}) {  // 1: the neighbour is behind
        const Tensor signs =
            AngularSigns(OnePair({0.4 * side, 0.3 * side, kLeans[own], kLeans[own]},
                                 {0, 0, kLeans[other], kLeans[other]}),
                         {})[0];
        const auto& theta = side > 0 ? kThetaBehind : kThetaAhead;
        const auto& phi = side > 0 ? kPhiBehind : kPhiAhead;
        EXPECT_EQ(signs[0].item<double>(), theta[own][other]) << own << other << side;
        EXPECT_EQ(signs[1].item<double>(), phi[own][other]) << own << other << side;
      }
    }
  }
}

// A line of people within reach of each other, whose first is pushed.
TakeTensors Line(int64_t people, int64_t frames) {
  Tensor position = torch::zeros({1, people, frames, 4});
  for (int64_t i = 0; i < people; ++i) {
    position.select(1, i).select(-1, 0).fill_(0.4 * static_cast<double>(i));
    position.select(1, i).select(-1, 2).fill_(0.05);
  }
  TakeTensors takes{
      .recorded = {position, torch::zeros_like(position), torch::ones({1, people, frames})},
      .hip = torch::zeros({1, people, frames, 3}),
      .mass = torch::full({1, people}, 75),
      .cart_height = torch::full({1, people}, 0.1),
      .push = torch::zeros({1, frames, 4}),
      .hip_push = torch::zeros({1, frames, 2}),
      .push_frames = torch::full({1}, 6, torch::kInt64),
      .mask = torch::ones({1, people, frames})};
  takes.hip_push.slice(1, 0, 6).select(-1, 0).fill_(250);
  return takes.To(kDouble);
}

TEST(LdpCrowdTest, GradientsOfTheInteractionAreFiniteDifferences) {
  torch::manual_seed(3);
  CrowdNet net(BalanceConfig{.self_input = 4, .self_hidden = 6, .rod_hidden = 4},
               InteractionConfig{.hidden = 8});
  net->to(kDouble);
  const TakeTensors takes = Line(3, 20);
  // How far the last one comes: only through the interaction of all others.
  const auto travel = [&] {
    return net->Rollout(takes, 20).states.position[0][2][19].select(0, 0);
  };
  travel().backward();
  for (const char* name : {"network.0.weight", "network.2.weight", "network.4.bias"}) {
    Tensor weight = net->interaction->named_parameters()[name];
    const Tensor gradient = weight.grad().clone().view({-1});
    EXPECT_GT(gradient.abs().max().item<double>(), 1e-6) << name;
    const torch::NoGradGuard no_gradient;
    constexpr double kStep = 1e-6;
    Tensor values = weight.view({-1});
    for (int64_t i = 0; i < 3; ++i) {
      const double before = values[i].item<double>();
      values[i] = before + kStep;
      const double more = travel().item<double>();
      values[i] = before - kStep;
      const double less = travel().item<double>();
      values[i] = before;
      const double slope = (more - less) / (2 * kStep);
      EXPECT_NEAR(gradient[i].item<double>(), slope, 1e-4 * std::abs(slope) + 1e-9) << name << i;
    }
  }
}

TEST(LdpCrowdTest, NobodyMovesBeforeSomethingActsOnThem) {
  const torch::NoGradGuard no_gradient;
  torch::manual_seed(4);
  CrowdNet net(BalanceConfig{}, InteractionConfig{});
  net->to(kDouble);
  TakeTensors takes = Line(3, 30);
  takes.recorded.position.select(1, 2).select(-1, 0).fill_(5);  // the last one is far away
  const CrowdPaths paths = net->Rollout(takes, 30);
  const Tensor last = paths.states.position[0][2];
  EXPECT_EQ((last - last[0]).abs().max().item<double>(), 0);
  EXPECT_EQ(paths.active[0][2].sum().item<double>(), 0);
  const Tensor middle = paths.states.position[0][1];
  EXPECT_GT((middle - middle[0]).abs().max().item<double>(), 1e-3);
}

TEST(LdpCrowdTest, TheReleasedPushMovesTheRecordedPendulum) {
  POISE_REQUIRE_DATA("fzj_push");
  // The released force of several people is the inverse dynamics of the recorded motion, friction
  // of 100 included: with nothing but friction and the recorded rods it gives that motion back.
  const torch::NoGradGuard no_gradient;
  const PushTake& take = testing::TakeNamed("row_2", 0);
  const PushTake* const one = &take;
  base::Random random(1);
  const TakeTensors takes = MakeTakeTensors(std::span(&one, 1), Protocol::kA, random).To(kDouble);
  PendulumTensors now{takes.recorded.position[0][0][0], torch::zeros({4}, kDouble), {}};
  for (int frame = 0; frame < take.push_frames; ++frame) {
    now.rod = takes.recorded.rod[0][0][frame + 1];
    Tensor force = takes.push[0][frame].clone();
    force.slice(0, 0, 2) -= 100 * now.velocity.slice(0, 0, 2);
    now.velocity = now.velocity + kFrameTime * Accelerations(now, takes.mass[0][0], force);
    now.position = now.position + kFrameTime * now.velocity;
    const Tensor off = now.position - takes.recorded.position[0][0][frame + 1];
    ASSERT_LT(off.abs().max().item<double>(), 2e-4) << frame;
  }
}

TEST(LdpBodyTest, AMixtureIsTheLayerOfMixedWeights) {
  const torch::NoGradGuard no_gradient;
  torch::manual_seed(6);
  const BodyConfig config{.latent = 3, .hidden = 5, .gate_hidden = 4, .experts = 2};
  MixtureDecoder decoder(4, 6, config);
  const Tensor latent = torch::randn({1, 3}), condition = torch::randn({1, 4});
  const auto weights = decoder->named_parameters();
  const auto layer = [&](const std::string& name, const Tensor& input) {
    return torch::linear(input, weights[name + ".weight"], weights[name + ".bias"]);
  };
  const Tensor seen = torch::cat({latent, condition}, 1);
  const Tensor gate = torch::softmax(
      layer("gate_out", torch::elu(layer("gate_second", torch::elu(layer("gate_first", seen))))),
      1)[0];
  // One weight matrix a layer, as the paper mixes them.
  const auto mixed = [&](const std::string& name, const Tensor& input) {
    const Tensor weight = weights[name + ".weight"].reshape({2, -1, input.size(1)});
    const Tensor bias = weights[name + ".bias"].reshape({2, -1});
    return torch::linear(input, gate[0] * weight[0] + gate[1] * weight[1],
                         gate[0] * bias[0] + gate[1] * bias[1]);
  };
  const Tensor first = torch::elu(mixed("first", seen));
  const Tensor second = torch::elu(mixed("second", torch::cat({latent, first}, 1)));
  const Tensor expected = mixed("out", torch::cat({latent, second}, 1));
  EXPECT_LT((decoder(latent, condition) - expected).abs().max().item<double>(), 1e-6);
}

TEST(LdpBodyTest, SizesAreThoseOfThePaper) {
  const BodyConfig config;
  const auto count = [](const torch::nn::Module& module) {
    int64_t numbers = 0;
    for (const Tensor& parameter : module.parameters()) numbers += parameter.numel();
    return numbers;
  };
  PartCvae lower(FeatureCount(9), FeatureCount(9), config);
  PartCvae upper(FeatureCount(14), FeatureCount(14) + 27, config);
  EXPECT_EQ(count(*lower->encoder), 198'400);
  EXPECT_EQ(count(*lower->decoder), 667'136);
  EXPECT_EQ(count(*upper->encoder), 259'072);
  EXPECT_EQ(count(*upper->decoder), 838'832);
  Interaction interaction(InteractionConfig{});
  EXPECT_EQ(count(*interaction), 270'340);
}

TEST(LdpConfigTest, PresetsAreCheckedByTheConfigThatKnowsThem) {
  EXPECT_TRUE(CheckPreset("paper", {{"body.parts", "full"}}).ok());
  EXPECT_TRUE(CheckPreset("recommended", {{"hip_members", "2"}}).ok());
  EXPECT_EQ(base::ErrorReason(CheckPreset("recommended", {{"body.parts", "full"}})),
            "UNKNOWN_CONFIG_KEY");
  EXPECT_EQ(base::ErrorReason(CheckPreset("papre", {})), "UNKNOWN_PRESET");
}

// Two subjects alone and one group, small networks, few steps.
std::vector<PushTake> FewTakes() {
  std::vector<PushTake> takes;
  for (const PushTake& take : testing::SingleTakes()) {
    if (take.group == "X05") takes.push_back(take);
  }
  for (const PushTake& take : testing::MultiTakes()) {
    if (take.group == "group_1" && take.index < 6) takes.push_back(take);
  }
  return takes;
}

LdpTraining SmallTraining() {
  const NetworkTraining few{.steps = 4, .batch_size = 2, .weight_decay = 0, .validate_every = 2};
  LdpTraining config;
  config.balance = {.self_input = 4, .self_hidden = 8, .rod_hidden = 8};
  config.interaction.hidden = 8;
  config.body = {.latent = 4, .hidden = 8, .gate_hidden = 4, .experts = 2};
  config.balance_training.network = few;
  config.interaction_training.network = few;
  config.cvae_training.network = few;
  config.cvae_training.rollout = 4;
  config.sampler_training = config.cvae_training;
  config.end_to_end.network = few;
  config.end_to_end.rounds = 1;
  return config;
}

TEST(TrainLdpTest, AnInterruptedTrainingEndsWithTheSameWeights) {
  POISE_REQUIRE_DATA("fzj_push");
  const std::vector<PushTake> takes = FewTakes();
  const LdpTask task{.takes = takes, .config = SmallTraining()};
  base::RunContext context;
  context.seed = 3;
  const auto whole = TrainLdp(task, context);
  ASSERT_TRUE(whole.ok()) << whole.status();
  EXPECT_EQ(whole->model.card.steps, 28);  // seven stages
  std::string checkpoint;
  base::RunContext stopped = context;
  stopped.cancellation = base::CancellationToken();
  stopped.progress = [&](const base::Progress& progress) {
    EXPECT_EQ(progress.total, 28);
    if (progress.step >= 14) stopped.cancellation.Cancel();
  };
  const learning::CheckpointSink sink{absl::ZeroDuration(), [&](std::string_view bytes, int64_t) {
                                        checkpoint = bytes;
                                        return absl::OkStatus();
                                      }};
  EXPECT_TRUE(absl::IsCancelled(TrainLdp(task, stopped, {}, sink).status()));
  ASSERT_FALSE(checkpoint.empty());
  const auto resumed = TrainLdp(task, context, checkpoint);
  ASSERT_TRUE(resumed.ok()) << resumed.status();
  EXPECT_EQ(resumed->model.card.weights_sha256, whole->model.card.weights_sha256);
  EXPECT_EQ(resumed->model.card.scores, whole->model.card.scores);
  EXPECT_EQ(base::ErrorReason(TrainLdp(task, context, "nonsense").status()), "CORRUPT_CHECKPOINT");
}

TEST(TrainLdpTest, EveryAblationTrainsAndIsScored) {
  POISE_REQUIRE_DATA("fzj_push");
  const std::vector<PushTake> takes = FewTakes();
  for (const bool pendulum : {true, false}) {
    for (const char* parts : {"low_up", "full"}) {
      LdpTraining config = SmallTraining();
      config.pendulum = pendulum;
      config.body.parts = parts;
      config.end_to_end.network.steps = 2;
      const auto trained = TrainLdp({.takes = takes, .config = config}, {});
      ASSERT_TRUE(trained.ok()) << trained.status();
      const auto test = TakesOf(takes, Split::kTest);
      const auto scores = EvaluatePush({{"paper", trained->model}}, test, {}, ForecastTakes);
      ASSERT_TRUE(scores.ok()) << scores.status();
      EXPECT_EQ(scores->size(), 8u);  // three anchors and the model, of either kind
      for (const TakeScores& take : scores->back().takes) {
        EXPECT_TRUE(std::isfinite(take.measures.at("mpjpe"))) << take.take;
      }
      EXPECT_EQ(base::ErrorReason(EvaluatePush({{"paper", trained->model}}, test, {}).status()),
                "WRONG_FAMILY");
    }
  }
}

}  // namespace
}  // namespace poise::push::ldp
