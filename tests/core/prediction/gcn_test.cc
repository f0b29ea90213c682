#include <gtest/gtest.h>

#include "core/learning/nn/module_state.h"
#include "core/motion/editing/cut.h"
#include "core/prediction/gcn/gcn_net.h"
#include "core/prediction/gcn/gcn_predictor.h"
#include "core/prediction/tensors/dct.h"
#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

using motion::Clip;

NetworkBody Body() {
  NetworkBody body{.skeleton = testing::Biped(), .frame_rate = 60, .joints = {}};
  for (int joint = 1; joint < body.skeleton->num_joints(); ++joint) body.joints.push_back(joint);
  return body;
}

// The first `nodes` columns count.
EulerMeasure Measure(int nodes, bool row_vectors = true) {
  torch::Tensor counts = torch::zeros({static_cast<int64_t>(3 * Body().joints.size())});
  counts.slice(0, 0, nodes).fill_(1);
  return {.row_vectors = row_vectors, .moving_only = false, .counts = counts};
}

GcnConfig Small() {
  return {.past_frames = 6, .future_frames = 4, .width = 12, .blocks = 2, .dropout = 0};
}

int64_t Parameters(const torch::nn::Module& net) {
  int64_t count = 0;
  for (const torch::Tensor& parameter : net.parameters()) count += parameter.numel();
  return count;
}

// Reference sec. 4.2 and 8.1.
TEST(GcnTest, PublishedSizesHaveThePublishedNumbersOfParameters) {
  NetworkBody body = Body();
  body.joints.assign(26, 1);
  EulerMeasure measure{.row_vectors = true, .moving_only = false, .counts = torch::zeros({78})};
  measure.counts.slice(0, 0, 64).fill_(1);
  EXPECT_EQ(Parameters(GcnNet(GcnConfig(), body, measure)), 2'522'915);
  measure.counts.slice(0, 48).fill_(0);
  EXPECT_EQ(Parameters(GcnNet({.past_frames = 10, .future_frames = 10}, body, measure)), 2'263'828);
  body.joints.assign(15, 1);  // and the root: MotionAug
  measure.counts = torch::ones({45});
  const GcnConfig motionaug{
      .past_frames = 12, .future_frames = 12, .coefficients = 20, .root = true, .moving = false};
  EXPECT_EQ(Parameters(GcnNet(motionaug, body, measure)), 2'309'950);
}

TEST(GcnTest, DctIsThatOfTheReference) {
  const torch::Tensor dct = DctMatrix(35);
  EXPECT_NEAR(dct[0][0].item<double>(), 0.1690308509, 1e-7);
  EXPECT_NEAR(dct[1][0].item<double>(), 0.2388050187, 1e-7);
  EXPECT_NEAR(dct[2][3].item<double>(), 0.1933920514, 1e-7);
  EXPECT_LT((torch::matmul(dct, dct.t()) - torch::eye(35)).abs().max().item<double>(), 1e-6);
}

class TrainedGcnTest : public ::testing::TestWithParam<bool> {};

// With batch norms that have seen data, for both senses of rotation vectors and held columns.
TEST_P(TrainedGcnTest, ServedForwardPassIsTheTrainedOne) {
  torch::manual_seed(3);
  GcnNet net(Small(), Body(), Measure(31, GetParam()));
  const Clip clip = testing::SwingingClip(60, 60);
  PoseWindows windows(10);
  windows.Add(clip, std::vector<int>{0, 7, 15, 22, 30, 41, 50});
  const PoseTensors batch = windows.Gather(std::vector<int64_t>{0, 1, 2, 3, 4, 5, 6});
  torch::optim::Adam adam(net.parameters(), torch::optim::AdamOptions(1e-2));
  for (int step = 0; step < 20; ++step) {
    adam.zero_grad();
    net.Loss(batch).backward();
    adam.step();
  }
  net.eval();
  const torch::NoGradGuard no_gradient;
  const PoseTensors expected = net.Predict(batch);
  base::TensorFile weights;
  ASSERT_TRUE(learning::AppendState(net, "", weights).ok());
  const auto predictor = GcnPredictor::Create(Small(), Body(), weights);
  ASSERT_TRUE(predictor.ok()) << predictor.status();
  std::vector<Observation> seen;
  for (const int start : {0, 7, 15, 22, 30, 41, 50}) seen.push_back({*motion::Cut(clip, start, 6)});
  const auto futures = (*predictor)->Predict(seen, 4, {});
  ASSERT_TRUE(futures.ok()) << futures.status();
  double moved = 0;
  for (int i = 0; i < 7; ++i) {
    const PoseTensors got = ToTensors(futures->at(i));
    const torch::Tensor sign = (got.rotations[0] * expected.rotations[i]).sum(-1, true).sign();
    EXPECT_LT((got.rotations[0] * sign - expected.rotations[i]).abs().max().item<double>(), 2e-5);
    moved = std::max(
        moved, math::GeodesicDistance(futures->at(i).rotation(3, 4), seen[i].past.rotation(5, 4)));
    EXPECT_EQ(futures->at(i).rotation(3, 0).coeffs(), seen[i].past.rotation(5, 0).coeffs());
  }
  EXPECT_GT(moved, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Senses, TrainedGcnTest, ::testing::Bool());

TEST(GcnTest, LearnsOneBatchByHeart) {
  torch::manual_seed(1);
  GcnNet net(Small(), Body(), Measure(24));
  PoseWindows windows(10);
  windows.Add(testing::SwingingClip(60, 60), std::vector<int>{0, 9, 20, 33, 47});
  const PoseTensors batch = windows.Gather(std::vector<int64_t>{0, 1, 2, 3, 4});
  torch::optim::Adam adam(net.parameters(), torch::optim::AdamOptions(3e-3));
  double first = 0, loss = 0;
  for (int step = 0; step < 800; ++step) {
    adam.zero_grad();
    torch::Tensor total = net.Loss(batch);
    total.backward();
    adam.step();
    loss = total.item<double>();
    if (step == 0) first = loss;
  }
  std::printf("loss %.4f -> %.4f\n", first, loss);
  EXPECT_LT(loss, 0.05 * first);
}

}  // namespace
}  // namespace poise::prediction
