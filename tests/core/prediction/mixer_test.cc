#include <gtest/gtest.h>

#include "core/learning/nn/module_state.h"
#include "core/motion/editing/cut.h"
#include "core/prediction/mixer/mixer_net.h"
#include "core/prediction/mixer/mixer_predictor.h"
#include "core/prediction/tensors/rotation_tensors.h"
#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

using motion::Clip;

NetworkBody Body() {
  NetworkBody body{.skeleton = testing::Biped(), .frame_rate = 60, .joints = {}};
  for (int joint = 1; joint < body.skeleton->num_joints(); ++joint) body.joints.push_back(joint);
  return body;
}

EulerMeasure Measure(int joints) { return {.counts = torch::ones({3 * joints})}; }

MixerConfig SmallConfig() {
  return {.past_frames = 12,
          .future_frames = 6,
          .width = 24,
          .groups = 3,
          .hidden = 32,
          .blocks = 2,
          .dropout = 0};
}

class MixerTest : public ::testing::Test {
 protected:
  MixerTest() {
    torch::manual_seed(5);
    net_ = std::make_shared<MixerNet>(SmallConfig(), Body(), Measure(20));
  }

  // Windows of a swinging body.
  static PoseTensors Windows(int count) {
    PoseWindows windows(18);
    const Clip clip = testing::SwingingClip(count + 17, 60);
    std::vector<int> starts(count);
    std::vector<int64_t> all(count);
    for (int i = 0; i < count; ++i) starts[i] = i, all[i] = i;
    windows.Add(clip, starts);
    return windows.Gather(all);
  }

  // Puts numbers into every weight, so that nothing is multiplied by zero.
  void Randomise() {
    const torch::NoGradGuard no_gradient;
    net_->Fit(Windows(40));
    for (torch::Tensor& parameter : net_->parameters())
      parameter.add_(0.3 * torch::randn_like(parameter));
    net_->eval();
  }

  std::shared_ptr<const MixerPredictor> Predictor() {
    base::TensorFile weights;
    EXPECT_TRUE(learning::AppendState(*net_, "", weights).ok());
    auto predictor = MixerPredictor::Create(SmallConfig(), Body(), weights);
    EXPECT_TRUE(predictor.ok()) << predictor.status();
    return *predictor;
  }

  std::shared_ptr<MixerNet> net_;
};

TEST_F(MixerTest, RecommendedSizeHasAsManyParametersAsItsLayersSay) {
  NetworkBody body = Body();
  body.joints.resize(20);
  for (int extra = 0; extra < 6; ++extra) body.joints.push_back(1);  // 26, as the CMU benchmark
  MixerNet net(MixerConfig(), body, Measure(26));
  int64_t parameters = 0;
  for (const torch::Tensor& parameter : net.parameters()) parameters += parameter.numel();
  EXPECT_EQ(parameters, 461'753);
}

TEST_F(MixerTest, UntrainedItHoldsTheLastPose) {
  const Clip clip = testing::SwingingClip(20, 60);
  const auto futures = Predictor()->Predict({{{clip}}}, 6, {});
  ASSERT_TRUE(futures.ok()) << futures.status();
  for (int joint = 0; joint < clip.num_joints(); ++joint) {
    EXPECT_LT(math::GeodesicDistance(futures->front().rotation(5, joint), clip.rotation(19, joint)),
              1e-7);
  }
  EXPECT_LT((futures->front().root_position(5) - clip.root_position(19)).norm(), 1e-9);
}

// The served forward pass is our own: it must be LibTorch's.
TEST_F(MixerTest, ServedForwardPassIsTheTrainedOne) {
  Randomise();
  const torch::NoGradGuard no_gradient;
  const PoseTensors expected = net_->Predict(Windows(30));
  const auto predictor = Predictor();
  const Clip clip = testing::SwingingClip(47, 60);
  std::vector<Observation> batch;
  for (int i = 0; i < 30; ++i) batch.push_back({*motion::Cut(clip, i, 12)});
  const auto futures = predictor->Predict(batch, 6, {});
  ASSERT_TRUE(futures.ok()) << futures.status();
  double most_moved = 0;
  for (int i = 0; i < 30; ++i) {
    const PoseTensors got = ToTensors(futures->at(i));
    const torch::Tensor overlap =
        (got.rotations[0] * expected.rotations[i]).sum(-1).abs().clamp_max(1);
    EXPECT_LT((1 - overlap).max().item<double>(), 1e-6);  // about 1e-3 rad squared
    EXPECT_LT((got.positions[0] - expected.positions[i]).abs().max().item<double>(), 1e-5);
    const torch::Tensor sign = (got.rotations[0] * expected.rotations[i]).sum(-1, true).sign();
    EXPECT_LT((got.rotations[0] * sign - expected.rotations[i]).abs().max().item<double>(), 1e-5);
    most_moved = std::max(most_moved, math::GeodesicDistance(futures->at(i).rotation(5, 3),
                                                             clip.rotation(i + 11, 3)));
  }
  EXPECT_GT(most_moved, 0.05);  // the comparison was not of standing still
}

TEST_F(MixerTest, BatchGivesWhatSingleCallsGive) {
  Randomise();
  const auto predictor = Predictor();
  const Clip clip = testing::SwingingClip(40, 60);
  std::vector<Observation> batch;
  for (int i = 0; i < 9; ++i) batch.push_back({*motion::Cut(clip, 3 * i, 12)});
  const auto together = predictor->Predict(batch, 6, {});
  for (size_t i = 0; i < batch.size(); ++i) {
    const auto alone = predictor->Predict({&batch[i], 1}, 6, {});
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      EXPECT_LT(
          (together->at(i).rotation(5, joint).coeffs() - alone->front().rotation(5, joint).coeffs())
              .norm(),
          1e-5);
    }
  }
}

TEST_F(MixerTest, WhereABodyStandsAndFacesChangesNothing) {
  Randomise();
  const auto predictor = Predictor();
  const Clip clip = testing::SwingingClip(12, 60);
  Clip moved = clip;
  const math::Quat turn = math::FromRotationVector({0, 2.1, 0});
  for (int frame = 0; frame < 12; ++frame) {
    moved.root_position(frame) = turn * clip.root_position(frame) + math::Vec3(5, 0, -3);
    moved.rotation(frame, 0) = turn * clip.rotation(frame, 0);
  }
  const auto here = predictor->Predict({{{clip}}}, 6, {});
  const auto there = predictor->Predict({{{moved}}}, 6, {});
  EXPECT_LT(math::GeodesicDistance(here->front().rotation(5, 4), there->front().rotation(5, 4)),
            1e-4);
  EXPECT_LT((turn * here->front().root_position(5) + math::Vec3(5, 0, -3) -
             there->front().root_position(5))
                .norm(),
            1e-4);
}

TEST_F(MixerTest, LearnsOneBatchByHeart) {
  const PoseTensors windows = Windows(8);
  net_->Fit(windows);
  const double held = net_->Loss(windows).item<double>();
  torch::optim::Adam adam(net_->parameters(), torch::optim::AdamOptions(5e-3));
  double loss = held;
  for (int step = 0; step < 600; ++step) {
    adam.zero_grad();
    torch::Tensor total = net_->Loss(windows);
    total.backward();
    adam.step();
    loss = total.item<double>();
  }
  std::printf("loss %.4f -> %.4f\n", held, loss);
  EXPECT_LT(loss, 0.05 * held);
}

TEST_F(MixerTest, WeightsOfOtherSizesAreRefused) {
  base::TensorFile weights;
  ASSERT_TRUE(learning::AppendState(*net_, "", weights).ok());
  MixerConfig config = SmallConfig();
  config.width = 27;
  EXPECT_EQ(base::ErrorReason(MixerPredictor::Create(config, Body(), weights).status()),
            "WRONG_SHAPE");
  weights.tensors.erase("scale");
  EXPECT_EQ(base::ErrorReason(MixerPredictor::Create(SmallConfig(), Body(), weights).status()),
            "MISSING_TENSOR");
}

}  // namespace
}  // namespace poise::prediction
