#include "core/push/training/hip_training.h"

#include <algorithm>

#include "core/learning/nn/guard.h"
#include "core/push/body_joints.h"

namespace poise::push {
namespace {

using torch::Tensor;

Tensor Distance(const Tensor& a, const Tensor& b) {
  return ((a - b).square().sum(-1) + 1e-8).sqrt();
}

// Mean over people and frames of each take, then over takes.
Tensor MeanOverTakes(const Tensor& values, const Tensor& mask) {
  return ((values * mask).sum({1, 2}) / mask.sum({1, 2}).clamp_min(1)).mean();
}

learning::Loss LossOf(const HipPaths& paths, const TakeBatch& batch, int64_t frames,
                      const HipTrainingConfig& config) {
  const auto cut = [&](const Tensor& whole) { return whole.slice(2, 0, frames); };
  const auto rate = [&](const Tensor& path) {
    return (path.slice(2, 1) - path.slice(2, 0, -1)) * kFrameRate;
  };
  const Tensor mask = cut(batch.mask);
  const Tensor place = MeanOverTakes(Distance(paths.hip, cut(batch.hip)), mask);
  const Tensor lean = MeanOverTakes(Distance(paths.lean, cut(batch.lean)), mask);
  const Tensor speed =
      MeanOverTakes(Distance(rate(paths.hip), rate(cut(batch.hip))), mask.slice(2, 1));
  return {.total = place + config.velocity_weight * speed + config.lean_weight * lean,
          .terms = {{"hip_m", place.item<double>()},
                    {"speed_mps", speed.item<double>()},
                    {"lean_rad", lean.item<double>()}}};
}

int64_t FramesAt(int64_t step, int64_t longest, const HipTrainingConfig& config) {
  const double grown = std::min(1.0, step / std::max(1.0, config.growing_share * config.steps));
  const double frames = config.first_frames + grown * (longest - config.first_frames);
  return std::min<int64_t>(longest, std::lround(frames));
}

}  // namespace

std::vector<base::Field> HipTrainingConfig::Fields() {
  return {
      base::Number("steps", &steps, int64_t{1}, int64_t{1'000'000}),
      base::Number("batch_size", &batch_size, 1, 1000),
      base::Number("learning_rate", &learning_rate, 1e-8, 1),
      base::Number("weight_decay", &weight_decay, 0, 1),
      base::Number("clip_norm", &clip_norm, 1e-6, 1e6),
      base::Number("first_frames", &first_frames, 2, 1000),
      base::Number("growing_share", &growing_share, 0, 1),
      base::Number("velocity_weight", &velocity_weight, 0, 10),
      base::Number("lean_weight", &lean_weight, 0, 10),
      base::Flag("mirror", &mirror),
      base::Number("validate_every", &validate_every, int64_t{1}, int64_t{1'000'000}),
  };
}

double HipAde(HipNet net, const TakeBatch& batch) {
  torch::NoGradGuard no_gradient;
  const Tensor paths = net->Rollout(batch, batch.frames()).hip;
  return MeanOverTakes(Distance(paths, batch.hip).slice(2, 1), batch.mask.slice(2, 1))
      .item<double>();
}

StatusOr<TrainedHip> TrainHip(const TrainingTakes& takes, Protocol protocol, const HipConfig& net,
                              const HipTrainingConfig& config, const base::RunContext& context) {
  return learning::Guard("train the hip network", [&]() -> StatusOr<TrainedHip> {
    learning::SeedTorch(context.seed);
    TrainedHip trained{HipNet(net), {}};
    base::Random noise(context.seed);
    const TakeBatch validation = MakeBatch(takes.validation, protocol, false, noise);
    const auto loss = [&](const learning::Batch& step) -> StatusOr<learning::Loss> {
      std::vector<const PushTake*> chosen;
      for (const int64_t sample : step.samples) chosen.push_back(takes.train[sample]);
      const TakeBatch batch = MakeBatch(chosen, protocol, config.mirror, step.random);
      const int64_t frames = FramesAt(step.step, batch.frames(), config);
      return LossOf(trained.net->Rollout(batch, frames), batch, frames, config);
    };
    learning::TrainingSetup setup;
    setup.networks.push_back({.name = "hip",
                              .module = trained.net.ptr(),
                              .optimizer = {.type = "adamw",
                                            .learning_rate = config.learning_rate,
                                            .weight_decay = config.weight_decay,
                                            .schedule = "cosine",
                                            .clip_norm = config.clip_norm},
                              .loss = loss});
    setup.num_samples = static_cast<int64_t>(takes.train.size());
    setup.validate = [&]() -> StatusOr<double> { return HipAde(trained.net, validation); };
    setup.seed = context.seed;
    POISE_ASSIGN_OR_RETURN(
        const auto trainer,
        learning::Trainer::Create(std::move(setup), {.steps = config.steps,
                                                     .batch_size = config.batch_size,
                                                     .validate_every = config.validate_every}));
    POISE_ASSIGN_OR_RETURN(trained.report, trainer->Run(context));
    return trained;
  });
}

}  // namespace poise::push
