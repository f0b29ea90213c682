#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/benchmark.h"
#include "bench/measure_rate.h"
#include "bench/predict_setup.h"
#include "core/base/random.h"
#include "core/motion/joint_roles.h"
#include "core/push/push_forecaster.h"
#include "core/push/standing_person.h"
#include "core/push/training/push_training_config.h"

/// How long one thread takes for a frame of a push forecast.
namespace poise::bench {
namespace {

constexpr int kFrames = 60;

push::ScenePerson PersonAt(double x, double y) {
  const motion::Clip& clip = push::StandingPerson();
  push::ScenePerson person =
      *push::PersonOf(clip, 0, *motion::JointRoles::Detect(*clip.skeleton()));
  person.mass_kg = 75;
  person.hip += push::Vec3(x, y, 0);
  person.pendulum.position.head<2>() += Eigen::Vector2d(x, y);
  return person;
}

push::PushScene BlockScene(int people, int columns) {
  constexpr double kSpacing = 0.45;  // [m]
  push::PushScene scene;
  for (int i = 0; i < people; ++i) {
    scene.people.push_back(PersonAt(kSpacing * (i / columns), kSpacing * (i % columns)));
  }
  scene.pushes.push_back(
      {.person = columns / 2, .first_frame = 0, .frames = 12, .force_n = Eigen::Vector2d(325, 0)});
  scene.frames = kFrames;
  return scene;
}

double MillisecondsPerFrame(const push::PushForecaster& forecaster, int people, int columns) {
  const push::PushScene scene = BlockScene(people, columns);
  const double rate = MeasureRate([&] {
    const auto rollout = forecaster.Start(scene);
    for (int frame = 0; frame < kFrames; ++frame) {
      if (!rollout->Next().ok()) std::abort();
    }
  });
  return 1000 / (rate * kFrames);
}

void AddLayer(base::TensorFile& file, const std::string& weight, const std::string& bias,
              int64_t out, int64_t in, base::Random& random, double scale = 1) {
  std::vector<float> values(out * in), zeros(out, 0);
  for (float& value : values)
    value = static_cast<float>(scale * random.Normal() / std::sqrt(1.0 * in));
  file.tensors[weight] = base::TensorRecord::FromFloats({out, in}, values);
  file.tensors[bias] = base::TensorRecord::FromFloats({out}, zeros);
}

void AddCell(base::TensorFile& file, const std::string& name, const std::string& suffix, int64_t in,
             int64_t hidden, base::Random& random) {
  AddLayer(file, name + "weight_ih" + suffix, name + "bias_ih" + suffix, 3 * hidden, in, random);
  AddLayer(file, name + "weight_hh" + suffix, name + "bias_hh" + suffix, 3 * hidden, hidden,
           random);
}

// A model of the recommended sizes that has learned nothing, which takes as long.
artifacts::ModelArtifact UntrainedModel() {
  constexpr double kGentle = 0.01;  // people stay together
  push::PushTraining config;
  base::Random random(1);
  artifacts::ModelArtifact model;
  model.card.family = push::kModelFamily;
  model.card.config = base::FieldsToJson(config.Fields());
  const push::HipConfig& hip = config.hip;
  for (int i = 0; i < config.hip_members; ++i) {
    const std::string name = fmt::format("hip{}.", i);
    AddLayer(model.weights, name + "message_in.weight", name + "message_in.bias",
             hip.message_hidden, push::kPairSize, random);
    AddLayer(model.weights, name + "message_out.weight", name + "message_out.bias", hip.message,
             hip.message_hidden, random);
    AddCell(model.weights, name + "cell.", "", push::kOwnSize + hip.message + push::kContextSize,
            hip.hidden, random);
    AddLayer(model.weights, name + "drive.weight", name + "drive.bias", push::kDriveSize,
             hip.hidden, random, kGentle);
  }
  for (int i = 0; i < config.pose_members; ++i) {
    const std::string name = fmt::format("pose{}.", i);
    AddCell(model.weights, name + "cell.", "_l0", push::kPathSize + push::kBodySize,
            config.pose.hidden, random);
    AddLayer(model.weights, name + "pose.weight", name + "pose.bias", push::kPoseSize,
             config.pose.hidden, random);
  }
  return model;
}

std::vector<Row> RowsOf(const std::string& name, const push::PushForecaster& forecaster) {
  const double thirteen = MillisecondsPerFrame(forecaster, 13, 3);
  const double hundred = MillisecondsPerFrame(forecaster, 100, 10);
  const double thousand = MillisecondsPerFrame(forecaster, 1000, 25);
  const double growth = (thousand / 1000) / (hundred / 100);
  const std::string prefix = "push/" + name + "/";
  return {{prefix + "13_people", thirteen, "ms/frame", "2 ms required", 2 / thirteen, 1},
          {prefix + "13_people_vs_paper", thirteen, "ms/frame", "paper: 190 ms on a GPU",
           190 / thirteen, 1},
          {prefix + "100_people", hundred, "ms/frame", "16 ms required", 16 / hundred, 1},
          {prefix + "1000_people", thousand, "ms/frame", "", 0, 1},
          {prefix + "per_person_1000_vs_100", growth, "x", "1.3 x required", 1.3 / growth, 1}};
}

// What forecasting for ten minutes leaves in memory. The first tenth may bring what stays.
Row TenMinutes(const push::PushForecaster& forecaster) {
  constexpr int kTenMinutes = 10 * 60 * 60, kFirst = kTenMinutes / 10;
  push::PushScene scene = BlockScene(13, 3);
  scene.frames = kTenMinutes;
  const auto rollout = forecaster.Start(scene);
  double before = 0;
  for (int frame = 0; frame < kTenMinutes; ++frame) {
    if (!rollout->Next().ok()) std::abort();
    if (frame == kFirst) before = MemoryMb();
  }
  const double after = MemoryMb();
  return {.name = "push/learned/10_minutes_memory",
          .value = after,
          .unit = "MB",
          .peer = fmt::format("{:.1f} MB after the first minute", before),
          .ratio = before / after};
}

}  // namespace

std::vector<Row> RunPushBenchmark() {
  std::vector<Row> rows = RowsOf("statue", **push::MakeStatueForecaster({}));
  const auto learned = *push::MakeLearnedForecaster(UntrainedModel());
  for (Row& row : RowsOf("learned", *learned)) rows.push_back(std::move(row));
  rows.push_back(TenMinutes(*learned));
  return rows;
}

}  // namespace poise::bench
