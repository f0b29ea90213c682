// The forecaster made of trained networks: what trains is what forecasts, wherever the scene lies.
#include <gmock/gmock.h>
#include <torch/torch.h>

#include "core/learning/nn/module_state.h"
#include "core/motion/joint_roles.h"
#include "core/push/evaluation/forecast_take.h"
#include "core/push/push_forecaster.h"
#include "core/push/standing_person.h"
#include "core/push/training/hip_training.h"
#include "core/push/training/pose_training.h"
#include "tests/core/push/fzj_data.h"

namespace poise::push {
namespace {

using torch::Tensor;

// Networks with random weights: they move people, but as nobody would. Those of the training path
// compute in double precision, so that a difference is the forecaster's own rounding.
struct RandomNetworks {
  PushTraining config;
  std::vector<HipNet> hips;
  std::vector<PoseNet> poses;
  artifacts::ModelArtifact model;
};

RandomNetworks MakeNetworks(const PushTraining& config) {
  torch::manual_seed(5);
  RandomNetworks made{.config = config, .hips = {}, .poses = {}, .model = {}};
  for (int i = 0; i < config.hip_members; ++i) {
    made.hips.emplace_back(config.hip);
    EXPECT_TRUE(learning::AppendState(*made.hips.back(), "hip" + std::to_string(i) + ".",
                                      made.model.weights)
                    .ok());
  }
  for (int i = 0; i < config.pose_members; ++i) {
    made.poses.emplace_back(config.pose);
    EXPECT_TRUE(learning::AppendState(*made.poses.back(), "pose" + std::to_string(i) + ".",
                                      made.model.weights)
                    .ok());
  }
  for (HipNet net : made.hips) net->to(torch::kFloat64);
  for (PoseNet net : made.poses) net->to(torch::kFloat64);
  made.model.card.family = kModelFamily;
  made.model.card.config = base::FieldsToJson(made.config.Fields());
  return made;
}

const RandomNetworks& Networks() {
  static const RandomNetworks networks = [] {
    PushTraining config;
    config.hip_members = config.pose_members = 2;
    config.pose.lookahead = 4;
    return MakeNetworks(config);
  }();
  return networks;
}

std::unique_ptr<PushForecaster> Forecaster() {
  auto forecaster = MakeLearnedForecaster(Networks().model);
  EXPECT_TRUE(forecaster.ok()) << forecaster.status();
  return *std::move(forecaster);
}

std::vector<PushFrame> Roll(const PushScene& scene, int frames) {
  const auto rollout = Forecaster()->Start(scene);
  std::vector<PushFrame> rolled;
  for (int frame = 0; frame < frames; ++frame) {
    const auto next = rollout->Next();
    EXPECT_TRUE(next.ok()) << next.status();
    rolled.push_back(**next);
  }
  return rolled;
}

// Hips as the training path moves them: (people, frames, 2), mean of the members.
Tensor TrainedHips(const PushTake& take, int64_t frames) {
  base::Random random(1);
  const PushTake* const takes[] = {&take};
  const TakeBatch batch = MakeBatch(takes, Protocol::kB, {}, random);
  TakeBatch longer = Extended(batch, frames);
  for (Tensor* tensor :
       {&longer.hip, &longer.lean, &longer.place, &longer.push, &longer.context, &longer.mask}) {
    *tensor = tensor->to(torch::kFloat64);
  }
  Tensor sum;
  for (HipNet net : Networks().hips) {
    const Tensor hip = net->Rollout(longer, frames).hip[0];
    sum = sum.defined() ? sum + hip : hip;
  }
  return sum / static_cast<double>(Networks().hips.size());
}

PushScene SceneOfTake(const PushTake& take) {
  base::Random random(1);
  return SceneOf(take, Protocol::kB, random);
}

double Largest(const PushScene& scene, const std::vector<PushFrame>& rolled, const Tensor& hips,
               int frames) {
  double largest = 0;
  for (int frame = 0; frame < frames; ++frame) {
    for (size_t i = 0; i < scene.people.size(); ++i) {
      for (int axis = 0; axis < 2; ++axis) {
        const double moved = rolled[frame].hips(i, axis) - scene.people[i].hip[axis];
        const double expected = hips[static_cast<int64_t>(i)][frame][axis].item<double>();
        largest = std::max(largest, std::abs(moved - expected));
      }
    }
  }
  return largest;
}

TEST(LearnedForecasterTest, MovesHipsAsTheTrainedNetworks) {
  POISE_REQUIRE_DATA("fzj_push");
  torch::NoGradGuard no_gradient;
  const PushTake& alone = testing::TakeNamed("X05", 0);
  const PushScene scene = SceneOfTake(alone);
  EXPECT_LT(
      Largest(scene, Roll(scene, alone.frames), TrainedHips(alone, alone.frames), alone.frames),
      1e-6);
  // Before anybody comes so near that trunks touch.
  constexpr int kFrames = 12;
  const PushTake& line = testing::TakeNamed("row_1", 0);
  const PushScene several = SceneOfTake(line);
  EXPECT_LT(Largest(several, Roll(several, kFrames), TrainedHips(line, kFrames), kFrames), 1e-6);
}

TEST(LearnedForecasterTest, PutsBodiesOnHipsAsTheTrainedNetworks) {
  POISE_REQUIRE_DATA("fzj_push");
  torch::NoGradGuard no_gradient;
  const PushTake& take = testing::TakeNamed("X05", 0);
  const int lookahead = Networks().config.pose.lookahead;
  PoseBatch batch = MakePoseBatch(PeopleOf({&take}), lookahead, {}, {}, nullptr);
  batch.hip = TrainedHips(take, take.frames + lookahead);
  batch.lean = batch.lean.to(torch::kFloat64);
  batch.body = batch.body.to(torch::kFloat64);
  Tensor heights;
  for (PoseNet net : Networks().poses) {
    const Tensor height = net->Forward(batch).height[0];
    heights = heights.defined() ? heights + height : height;
  }
  heights = heights / static_cast<double>(Networks().poses.size());
  const PushScene scene = SceneOfTake(take);
  const auto rolled = Roll(scene, take.frames);
  for (int frame = 1; frame < take.frames; ++frame) {
    ASSERT_NEAR(rolled[frame].hips(0, 2) - scene.people[0].hip.z(), heights[frame].item<double>(),
                1e-6)
        << frame;
  }
}

ScenePerson PersonAt(double x, double y) {
  const motion::Clip& clip = StandingPerson();
  ScenePerson person = *PersonOf(clip, 0, *motion::JointRoles::Detect(*clip.skeleton()));
  person.mass_kg = 75;
  person.hip += Vec3(x, y, 0);
  person.pendulum.position.head<2>() += Eigen::Vector2d(x, y);
  return person;
}

PushScene Line(int people, double spacing = 0.6) {
  PushScene scene;
  for (int i = 0; i < people; ++i) scene.people.push_back(PersonAt(spacing * i, 0.02 * i));
  scene.pushes.push_back({.person = 0, .first_frame = 0, .frames = 12, .force_n = {200, 0}});
  return scene;
}

// The scene somewhere else, turned about the vertical.
PushScene Moved(const PushScene& scene, const Eigen::AngleAxisd& turn, const Vec3& shift) {
  PushScene moved = scene;
  for (ScenePerson& person : moved.people) {
    person.hip = turn * person.hip + shift;
    for (Vec3& joint : person.shape) joint = turn * joint;
    const Vec3 cart = turn * Vec3(person.pendulum.position[0], person.pendulum.position[1],
                                  person.pendulum.cart_height) +
                      shift;
    // The ankles' middle is all that a pendulum needs.
    person.pendulum = PendulumOf(person.hip, cart, cart);
  }
  for (ScenePush& push : moved.pushes) {
    push.force_n = (turn * Vec3(push.force_n.x(), push.force_n.y(), 0)).head<2>();
  }
  return moved;
}

TEST(LearnedForecasterTest, PlaceAndDirectionDoNotMatter) {
  constexpr int kFrames = 60;
  const PushScene scene = Line(4);
  const Eigen::AngleAxisd turn(1.2, Vec3::UnitZ());
  const Vec3 shift(120, -45, 0);
  const auto here = Roll(scene, kFrames), there = Roll(Moved(scene, turn, shift), kFrames);
  ASSERT_GT((here.back().hips - here.front().hips).abs().maxCoeff(), 0.1);
  for (int frame = 0; frame < kFrames; ++frame) {
    for (int i = 0; i < 4; ++i) {
      const Vec3 hip = here[frame].hips.row(i).matrix().transpose();
      const Vec3 other = there[frame].hips.row(i).matrix().transpose();
      ASSERT_LT((turn * hip + shift - other).norm(), 1e-4) << frame << " " << i;
      const Vec3 knee = turn * Turned(scene.people[i].shape, here[frame].turns[i])[15];
      BodyShape body = scene.people[i].shape;
      for (Vec3& joint : body) joint = turn * joint;
      ASSERT_LT((knee - Turned(body, there[frame].turns[i])[15]).norm(), 1e-4) << frame;
    }
  }
}

TEST(LearnedForecasterTest, WhoIsFarFromThePushStandsStill) {
  PushScene scene = Line(2);
  scene.people.push_back(PersonAt(6, 0));
  for (const PushFrame& frame : Roll(scene, 60)) {
    ASSERT_EQ(Vec3(frame.hips.row(2).matrix().transpose()), scene.people[2].hip);
    ASSERT_EQ(frame.onset_frames[2], -1);
    for (const math::Quat& turn : frame.turns[2]) ASSERT_EQ(turn.w(), 1);
  }
}

TEST(LearnedForecasterTest, AFarGroupChangesNothing) {
  const PushScene scene = Line(3);
  PushScene more = scene;
  more.people.push_back(PersonAt(0, 30));
  more.pushes.push_back({.person = 3, .first_frame = 5, .frames = 8, .force_n = {0, -150}});
  const auto alone = Roll(scene, 60), beside = Roll(more, 60);
  EXPECT_LT((alone.back().hips - beside.back().hips.topRows(3)).abs().maxCoeff(), 1e-5);
  EXPECT_GT(std::abs(beside.back().hips(3, 1) - 30), 0.05);
}

TEST(LearnedForecasterTest, EverybodyComesToRestAndMovesAgainWhenPushedAgain) {
  PushScene scene = Line(3);
  constexpr int kSecond = 900;
  ScenePush again = scene.pushes[0];
  again.first_frame = kSecond;
  scene.pushes.push_back(again);
  const auto rolled = Roll(scene, kSecond + 60);
  const auto moved = [&](int from, int to) {
    return (rolled[to].hips - rolled[from].hips).leftCols<2>().abs().maxCoeff();
  };
  EXPECT_GT(moved(0, 60), 0.05);
  EXPECT_LT(moved(kSecond - 60, kSecond), 1e-3);
  EXPECT_GT(moved(kSecond, kSecond + 59), 0.05);
}

TEST(LearnedForecasterTest, BonesKeepTheirLengths) {
  const PushScene scene = Line(2);
  const BodyShape& first = scene.people[0].shape;
  for (const PushFrame& frame : Roll(scene, 40)) {
    const BodyShape body = Turned(first, frame.turns[0]);
    for (int joint = 1; joint < kBodyJoints; ++joint) {
      const int parent = kBodyParents[joint];
      ASSERT_NEAR((body[joint] - body[parent]).norm(), (first[joint] - first[parent]).norm(),
                  1e-12);
    }
  }
}

TEST(LearnedForecasterTest, AFootStandsExactlyUntilItSteps) {
  const PushScene scene = Line(1);
  const auto toe = [&](const PushFrame& frame, int foot) {
    return Vec3(frame.hips.row(0).matrix().transpose() +
                Turned(scene.people[0].shape, frame.turns[0])[kToes[foot]]);
  };
  const auto rolled = Roll(scene, 90);
  ASSERT_GT((rolled.back().hips - rolled.front().hips).abs().maxCoeff(), 0.1);
  for (size_t frame = 1; frame < rolled.size(); ++frame) {
    const double right = (toe(rolled[frame], 0) - toe(rolled[frame - 1], 0)).norm();
    const double left = (toe(rolled[frame], 1) - toe(rolled[frame - 1], 1)).norm();
    ASSERT_LT(std::min(right, left), 1e-6) << frame;
  }
}

TEST(LearnedForecasterTest, RefusesOtherModels) {
  artifacts::ModelArtifact model = Networks().model;
  model.weights.tensors.erase("hip1.drive.weight");
  EXPECT_EQ(base::ErrorReason(MakeLearnedForecaster(model).status()), "MISSING_TENSOR");
  model.card.family = "mixer";
  EXPECT_EQ(base::ErrorReason(MakeLearnedForecaster(model).status()), "WRONG_FAMILY");
}

}  // namespace
}  // namespace poise::push
