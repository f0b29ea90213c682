// That bench/train_baselines.py trains the networks that are served: its losses, first gradients
// and held-out errors are LibTorch's.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/learning/nn/module_state.h"
#include "core/prediction/gcn/gcn_net.h"
#include "core/prediction/potr/potr_net.h"
#include "core/prediction/predictor_registry.h"
#include "core/prediction/training/train_predictor.h"
#include "tests/support/process.h"
#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

namespace fs = std::filesystem;

constexpr int kWindows = 8;  // of one batch
constexpr int kPast = 6, kFuture = 4;
const fs::path kBench = fs::path(POISE_SOURCE_DIR) / "bench";

// One that can import PyTorch; empty without any.
std::string PythonWithTorch() {
  for (const char* python : {POISE_PYTHON, "/usr/bin/python3"}) {
    if (testing::Process({python, "-c", "import torch, numpy"}).Wait() == 0) return python;
  }
  return "";
}

motion::BenchmarkClips Swings(bool row_vectors) {
  motion::BenchmarkClips clips;
  for (const uint64_t seed : {1, 2}) {
    clips.train.push_back({"swing", "", testing::SwingingClip(90, 60, 0.3, seed)});
  }
  clips.counts.assign(3 * testing::Biped()->num_joints(), true);
  for (int column = 8; column < 20; ++column) clips.counts[column] = false;
  clips.sense =
      row_vectors ? motion::RotationSense::kRowVectors : motion::RotationSense::kColumnVectors;
  clips.variant = row_vectors ? motion::EulerErrorVariant::kMovingColumns
                              : motion::EulerErrorVariant::kAllColumns;
  return clips;
}

// As on CMU, or as on HDM05.
PredictorTask Task(const std::string& family, bool cmu, double dropout) {
  PredictorTask task{.clips = Swings(cmu), .config = {}};
  PredictorTraining& config = task.config;
  config = *PredictorTraining::FromPreset(family + (cmu ? "" : "-hdm05"));
  config.gcn = {.past_frames = kPast,
                .future_frames = kFuture,
                .coefficients = cmu ? 0 : 8,
                .root = !cmu,
                .moving = cmu,
                .width = 12,
                .blocks = 2,
                .dropout = dropout};
  config.potr = {.past_frames = kPast,
                 .future_frames = kFuture,
                 .root = !cmu,
                 .node_width = 12,
                 .joint_width = 6,
                 .width = 16,
                 .heads = 2,
                 .layers = 2,
                 .hidden = 24,
                 .dropout = dropout,
                 .residual = cmu};
  config.validation_share = 0.2;
  config.trainer.steps = 2;
  return task;
}

std::shared_ptr<PredictorNet> MakeNet(const PredictorTask& task, const base::TensorFile& windows) {
  const NetworkBody body = NetworkBody::Of(task.clips);
  const auto number = [&](const char* name) {
    return learning::FromRecord(windows.tensors.at(name));
  };
  const EulerMeasure measure{.row_vectors = number("row_vectors").item<float>() > 0,
                             .moving_only = number("moving_only").item<float>() > 0,
                             .counts = number("counts")};
  if (task.config.family == "gcn") {
    return std::make_shared<GcnNet>(task.config.gcn, body, measure);
  }
  return std::make_shared<PotrNet>(task.config.potr, body, measure);
}

PoseTensors WindowsOf(const base::TensorFile& file, const std::string& prefix, int64_t count) {
  const auto tensor = [&](const char* name) {
    return learning::FromRecord(file.tensors.at(prefix + name));
  };
  torch::Tensor starts = tensor("starts");
  if (count > 0) starts = starts.slice(0, 0, count);
  const torch::Tensor frames =
      (starts.unsqueeze(1) + torch::arange(kPast + kFuture, torch::kInt64)).flatten();
  const torch::Tensor rotations = tensor("rotations");
  return {rotations.index_select(0, frames).view(
              {starts.size(0), kPast + kFuture, rotations.size(1), 4}),
          tensor("positions").index_select(0, frames).view({starts.size(0), kPast + kFuture, 3})};
}

base::TensorFile Read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return *base::DecodeTensors(std::string(std::istreambuf_iterator<char>(file), {}), path.string());
}

/// Two seeds that are trained together, begun in a folder.
class TrainBaselinesTest : public ::testing::TestWithParam<std::tuple<const char*, bool>> {
 protected:
  void SetUp() override {
    python_ = PythonWithTorch();
    if (python_.empty()) GTEST_SKIP() << "no python3 with PyTorch and NumPy here";
  }

  void Begin(const PredictorTask& task) {
    for (const uint64_t seed : {1, 2}) {
      const auto begun = BeginPredictor(task, seed);
      ASSERT_TRUE(begun.ok()) << begun.status();
      const fs::path folder = Begun(seed);
      fs::create_directories(folder);
      ASSERT_TRUE(artifacts::WriteModelFolder(begun->model, folder).ok());
      models_.push_back(begun->model);
      windows_ = begun->windows;
    }
    std::ofstream(folder_.path() / "begun.safetensors", std::ios::binary)
        << base::EncodeTensors(windows_);
  }
  void RunPython(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {python_, "-B"});
    testing::Process process(arguments, {{"OMP_NUM_THREADS", "1"}});
    ASSERT_EQ(process.Wait(absl::Minutes(3)), 0) << process.ErrorOutput();
  }
  fs::path Begun(uint64_t seed) const { return folder_.path() / ("begun_" + std::to_string(seed)); }

  std::string python_;
  testing::TemporaryFolder folder_;
  std::vector<artifacts::ModelArtifact> models_;
  base::TensorFile windows_;
};

TEST_P(TrainBaselinesTest, LossesAndGradientsAreThoseOfLibTorch) {
  const auto [family, cmu] = GetParam();
  const PredictorTask task = Task(family, cmu, 0);
  Begin(task);
  const fs::path found_path = folder_.path() / "found";
  RunPython({POISE_TEST_PROBE, kBench, std::to_string(kWindows), found_path, Begun(1), Begun(2)});
  const base::TensorFile found = Read(found_path);
  for (size_t i = 0; i < models_.size(); ++i) {
    const std::shared_ptr<PredictorNet> net = MakeNet(task, windows_);
    ASSERT_TRUE(learning::LoadState(models_[i].weights, "", *net).ok());
    const torch::Tensor loss = net->Loss(WindowsOf(windows_, "train.", kWindows));
    loss.backward();
    const std::string name = "begun_" + std::to_string(i + 1) + ".";
    const auto of = [&](const std::string& what) {
      return learning::FromRecord(found.tensors.at(name + what));
    };
    EXPECT_NEAR(of("loss").item<double>(), loss.item<double>(), 1e-5 * loss.item<double>());
    double longest = 0;
    for (const auto& item : net->named_parameters()) {
      longest = std::max(longest, item.value().grad().abs().max().item<double>());
    }
    EXPECT_GT(longest, 1e-3);
    for (const auto& item : net->named_parameters()) {
      const torch::Tensor apart = of(item.key()) - item.value().grad();
      // A norm divides by the deviation of a column, and some hardly move: so few digits.
      EXPECT_LT(apart.abs().max().item<double>(), 5e-4 * longest) << item.key();
    }
  }
}

TEST_P(TrainBaselinesTest, TrainedModelsAreServedWithTheErrorOnTheirCards) {
  const auto [family, cmu] = GetParam();
  const PredictorTask task = Task(family, cmu, 0.3);
  Begin(task);
  const fs::path trained = folder_.path() / "trained";
  RunPython({kBench / "train_baselines.py", Begun(1), Begun(2), "--out", trained});
  for (size_t i = 0; i < models_.size(); ++i) {
    const auto model = artifacts::ReadModelFolder(trained / Begun(i + 1).filename());
    ASSERT_TRUE(model.ok()) << model.status();
    EXPECT_EQ(model->card.steps, 2);
    EXPECT_EQ(model->card.seed, i + 1);
    EXPECT_NE(base::EncodeTensors(model->weights), base::EncodeTensors(models_[i].weights));
    EXPECT_TRUE(MakeTrainedPredictor(*model).ok());
    const std::shared_ptr<PredictorNet> net = MakeNet(task, windows_);
    ASSERT_TRUE(learning::LoadState(model->weights, "", *net).ok());
    net->eval();
    const torch::NoGradGuard no_gradient;
    const NetworkBody body = NetworkBody::Of(task.clips);
    const torch::Tensor joints =
        torch::tensor(std::vector<int64_t>(body.joints.begin(), body.joints.end()));
    const PoseTensors held_out = WindowsOf(windows_, "validation.", 0);
    const EulerMeasure measure{.row_vectors = cmu,
                               .moving_only = cmu,
                               .counts = learning::FromRecord(windows_.tensors.at("counts"))};
    const torch::Tensor errors =
        measure.Errors(net->Predict(held_out).rotations.index_select(2, joints),
                       held_out.rotations.slice(1, kPast).index_select(2, joints));
    EXPECT_NEAR(errors.mean().item<double>(), model->card.scores.at("validation_rad"), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, TrainBaselinesTest,
                         ::testing::Combine(::testing::Values("gcn", "potr"), ::testing::Bool()));

TEST(BeginPredictorTest, RefusesWindowsThatItsFileDoesNotSay) {
  PredictorTask task = Task("gcn", true, 0);
  task.config.balanced = true;
  EXPECT_EQ(base::ErrorReason(BeginPredictor(task, 1).status()), "CONFIG_VALUE_OUT_OF_RANGE");
}

}  // namespace
}  // namespace poise::prediction
