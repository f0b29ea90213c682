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
                      const HipTraining& config) {
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

int64_t FramesAt(int64_t step, int64_t longest, const HipTraining& config) {
  const double grown =
      std::min(1.0, step / std::max(1.0, config.growing_share * config.network.steps));
  const double frames = config.first_frames + grown * (longest - config.first_frames);
  return std::min<int64_t>(longest, std::lround(frames));
}

}  // namespace

double HipAde(HipNet net, const TakeBatch& batch) {
  torch::NoGradGuard no_gradient;
  const Tensor paths = net->Rollout(batch, batch.frames()).hip;
  return MeanOverTakes(Distance(paths, batch.hip).slice(2, 1), batch.mask.slice(2, 1))
      .item<double>();
}

StatusOr<TrainedHip> TrainHip(const TrainingTakes& takes, Protocol protocol, const HipConfig& net,
                              const HipTraining& config, const base::RunContext& context,
                              const Resumption& resumption) {
  return learning::Guard("train the hip network", [&]() -> StatusOr<TrainedHip> {
    learning::SeedTorch(context.seed);
    TrainedHip trained{HipNet(net), {}, {}};
    base::Random noise(context.seed);
    const TakeBatch validation = MakeBatch(takes.validation, protocol, {}, noise);
    const auto loss = [&](const learning::Batch& step) -> StatusOr<learning::Loss> {
      std::vector<const PushTake*> chosen;
      for (const int64_t sample : step.samples) chosen.push_back(takes.train[sample]);
      const TakeBatch batch =
          MakeBatch(chosen, protocol, {.mirror = config.mirror, .still_share = config.still_share},
                    step.random);
      const int64_t frames = FramesAt(step.step, batch.frames(), config);
      return LossOf(trained.net->Rollout(batch, frames), batch, frames, config);
    };
    NetworkTask task{
        .name = "hip",
        .module = trained.net.ptr(),
        .config = config.network,
        .num_samples = static_cast<int64_t>(takes.train.size()),
        .loss = loss,
        .validate = [&]() -> StatusOr<double> { return HipAde(trained.net, validation); }};
    POISE_ASSIGN_OR_RETURN(trained.report,
                           TrainNetwork(std::move(task), context, resumption, &trained.curve_csv));
    return trained;
  });
}

void AddForecasts(HipNet net, const std::vector<const PushTake*>& takes, Protocol protocol,
                  int64_t ahead, base::Random& random, HipForecasts& forecasts) {
  torch::NoGradGuard no_gradient;
  for (const PushTake* take : takes) {
    const int64_t frames = take->frames + ahead;
    const HipPaths paths =
        net->Rollout(Extended(MakeBatch({&take, 1}, protocol, {}, random), frames), frames);
    forecasts.insert_or_assign(take, HipPaths{paths.hip[0], paths.lean[0]});
  }
}

}  // namespace poise::push
