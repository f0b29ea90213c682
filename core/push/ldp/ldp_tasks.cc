#include "core/push/ldp/ldp_tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace poise::push::ldp {
namespace {

using torch::Tensor;

// Noise of protocol C in validation: the same each time.
constexpr uint64_t kValidationSeed = 1;

// Gradients begin as zeros, also after a resume: the first one would else keep the layout in which
// it was computed, and its norm another rounding.
void LearnOnly(torch::nn::Module& whole, torch::nn::Module& part) {
  for (Tensor& parameter : whole.parameters()) parameter.set_requires_grad(false);
  for (Tensor& parameter : part.parameters()) {
    parameter.set_requires_grad(true);
    parameter.mutable_grad() = torch::zeros_like(parameter);
  }
}

std::vector<const PushTake*> Choose(const std::vector<const PushTake*>& takes,
                                    std::span<const int64_t> samples) {
  std::vector<const PushTake*> chosen;
  for (const int64_t sample : samples) chosen.push_back(takes[sample]);
  return chosen;
}

Tensor CrowdLoss(const CrowdErrors& errors, const PendulumTraining& config) {
  return errors.states + config.phi_rate_weight * errors.phi_rate + config.rod_weight * errors.rod +
         config.hip_weight * errors.hip;
}

int64_t FramesAt(int64_t step, int64_t longest, const PendulumTraining& config) {
  const double growing = config.growing_share * static_cast<double>(config.network.steps);
  const double grown = std::min(1.0, static_cast<double>(step) / std::max(1.0, growing));
  const double frames = config.first_frames + grown * static_cast<double>(longest);
  return std::min(longest, std::lround(frames));
}

NetworkTask CrowdTask(std::string name, LdpNet net, std::shared_ptr<torch::nn::Module> part,
                      std::shared_ptr<const LdpTakes> all, const TrainingTakes& takes,
                      const PendulumTraining& config, Protocol protocol) {
  LearnOnly(*net, *part);
  base::Random noise(kValidationSeed);
  const TakeTensors validation = MakeTakeTensors(takes.validation, protocol, noise);
  CrowdNet crowd = net->crowd;
  const auto loss = [=, &takes](const learning::Batch& step) mutable -> StatusOr<learning::Loss> {
    const TakeTensors batch =
        MakeTakeTensors(Choose(takes.train, step.samples), protocol, step.random);
    const CrowdErrors errors =
        ErrorsOf(crowd->Rollout(batch, FramesAt(step.step, batch.frames(), config)), batch);
    return learning::Loss{.total = CrowdLoss(errors, config),
                          .terms = {{"states", errors.states.item<double>()},
                                    {"rod_m", errors.rod.item<double>()},
                                    {"hip_m", errors.hip.item<double>()}}};
  };
  return {.name = std::move(name),
          .module = std::move(part),
          .config = config.network,
          .num_samples = static_cast<int64_t>(takes.train.size()),
          .loss = loss,
          .validate = [=]() mutable -> StatusOr<double> {
            (void)all;  // keeps the takes
            return ErrorsOf(crowd->Rollout(validation, validation.frames()), validation)
                .hip.item<double>();
          }};
}

Tensor RowsAt(const Tensor& rows, const std::vector<int64_t>& starts, int64_t ahead) {
  return rows.index_select(0, torch::tensor(starts) + ahead);
}

Tensor MeanSquare(const Tensor& a, const Tensor& b) { return (a - b).square().mean(); }

std::vector<int64_t> Choose(const std::vector<int64_t>& starts, std::span<const int64_t> samples) {
  std::vector<int64_t> chosen;
  for (const int64_t sample : samples) chosen.push_back(starts[sample]);
  return chosen;
}

// The share of steps in which the next condition is the recorded one (scheduled sampling).
double TeacherChance(int64_t step, const BodyTraining& config) {
  const double share = static_cast<double>(step) / static_cast<double>(config.network.steps);
  if (share < config.teacher_share) return 1;
  return std::max(0.0, 1 - (share - config.teacher_share) / std::max(1e-9, config.ramp_share));
}

// One roll-out of a CVAE that sees what it is to make.
learning::Loss CvaeLoss(LdpNet net, size_t part, const BodyRows& rows,
                        const std::vector<int64_t>& starts, const BodyTraining& config,
                        const std::function<bool()>& teacher) {
  PartCvae cvae = net->body->cvae(part);
  Tensor now = RowsAt(rows.parts[part], starts, 0);
  Tensor squares = torch::zeros({}), divergence = torch::zeros({});
  for (int64_t ahead = 1; ahead <= config.rollout; ++ahead) {
    const Tensor target = RowsAt(rows.parts[part], starts, ahead);
    const Tensor condition = net->body->Condition(part, now, RowsAt(rows.parts[0], starts, ahead));
    const LatentTensors latent = cvae->encoder(target, condition);
    const Tensor made = cvae->decoder(cvae->is_training() ? latent.Draw() : latent.mean, condition);
    squares = squares + MeanSquare(made, target) / config.rollout;
    divergence = divergence + Divergence(latent) / config.rollout;
    now = teacher() ? target : made.detach();
  }
  return {.total = squares + config.kl_weight * divergence,
          .terms = {{"reconstruction", squares.item<double>()},
                    {"divergence", divergence.item<double>()}}};
}

// Skating of toes in normalised features of a part [m/s]: as FSE, of what touches the floor.
Tensor FootSkate(LdpNet net, size_t part, const Tensor& features) {
  constexpr double kHeight = 0.05;
  const auto& joints = net->body->parts()[part];
  const Tensor raw = net->body->RawPart(part, features) / 1000;
  const auto count = static_cast<int64_t>(joints.size());
  Tensor skate = torch::zeros({});
  for (const int toe : {kRightToe, kLeftToe}) {
    const auto found = std::find(joints.begin(), joints.end(), toe);
    if (found == joints.end()) continue;
    const int64_t first = 3 + 3 * (found - joints.begin());
    const Tensor height = raw.select(-1, first + 2).clamp(0, kHeight);
    const Tensor step = raw.slice(-1, first + 3 * count, first + 3 * count + 2);
    const Tensor speed = (step.square().sum(-1) + 1e-12).sqrt() * kFrameRate;
    skate = skate + (speed * (2 - torch::pow(2.0, height / kHeight))).mean() / 2;
  }
  return skate;
}

// One roll-out in which the sampler chooses the latents, on its own poses.
learning::Loss SamplerLoss(LdpNet net, size_t part, const BodyRows& rows,
                           const std::vector<int64_t>& starts, const BodyTraining& config) {
  PartCvae cvae = net->body->cvae(part);
  LatentEncoder sampler = net->body->sampler(part);
  Tensor now = RowsAt(rows.parts[part], starts, 0);
  Tensor squares = torch::zeros({}), latents = torch::zeros({}), skate = torch::zeros({});
  for (int64_t ahead = 1; ahead <= config.rollout; ++ahead) {
    const Tensor target = RowsAt(rows.parts[part], starts, ahead);
    const Tensor condition = net->body->Condition(part, now, RowsAt(rows.parts[0], starts, ahead));
    const LatentTensors wanted = cvae->encoder(target, condition);
    const LatentTensors found = sampler(RowsAt(rows.pendulum, starts, ahead), condition);
    const Tensor made = cvae->decoder(found.mean, condition);
    squares = squares + MeanSquare(made, target) / config.rollout;
    latents = latents + (MeanSquare(found.mean, wanted.mean.detach()) +
                         MeanSquare(found.log_variance, wanted.log_variance.detach())) /
                            config.rollout;
    if (config.foot_weight > 0) skate = skate + FootSkate(net, part, made) / config.rollout;
    now = made.detach();
  }
  return {.total = config.reconstruction_weight * squares + config.latent_weight * latents +
                   config.foot_weight * skate,
          .terms = {{"reconstruction", squares.item<double>()},
                    {"latent", latents.item<double>()},
                    {"skate_mps", skate.item<double>()}}};
}

// Recorded windows on which a pose model chooses its step.
std::vector<int64_t> ValidationStarts(const BodyRows& rows, const BodyTraining& config) {
  return rows.Starts(config.rollout, config.rollout);
}

}  // namespace

LdpTakes::LdpTakes(const TrainingTakes& takes) {
  for (const PushTake* take : takes.train) (take->multi ? several : single).train.push_back(take);
  for (const PushTake* take : takes.validation) {
    (take->multi ? several : single).validation.push_back(take);
  }
}

NetworkTask BalanceTask(LdpNet net, std::shared_ptr<const LdpTakes> takes,
                        const LdpTraining& config) {
  return CrowdTask("balance", net, net->crowd->balance.ptr(), takes, takes->single,
                   config.balance_training, *ParseProtocol(config.protocol));
}

NetworkTask InteractionTask(LdpNet net, std::shared_ptr<const LdpTakes> takes,
                            const LdpTraining& config) {
  return CrowdTask("interaction", net, net->crowd->interaction.ptr(), takes, takes->several,
                   config.interaction_training, *ParseProtocol(config.protocol));
}

BodySamples::BodySamples(LdpNet net, const LdpTakes& takes) {
  const auto rows_of = [&](const std::vector<const PushTake*>& single,
                           const std::vector<const PushTake*>& several) {
    std::vector<const PushTake*> all = single;
    all.insert(all.end(), several.begin(), several.end());
    return MakeBodyRows(PeopleOf(all), net->body->parts());
  };
  train = rows_of(takes.single.train, takes.several.train);
  validation = rows_of(takes.single.validation, takes.several.validation);
  net->body->SetStatistics(train);
  for (BodyRows* rows : {&train, &validation}) {
    for (size_t part = 0; part < rows->parts.size(); ++part) {
      rows->parts[part] = net->body->NormalPart(part, rows->parts[part]);
    }
    rows->pendulum = net->body->NormalPendulum(rows->pendulum);
  }
}

NetworkTask CvaeTask(LdpNet net, size_t part, std::shared_ptr<const BodySamples> samples,
                     const BodyTraining& config) {
  LearnOnly(*net, *net->body->cvae(part));
  const std::vector<int64_t> starts = samples->train.Starts(config.rollout);
  const auto held_out = ValidationStarts(samples->validation, config);
  return {.name = fmt::format("cvae{}", part),
          .module = net->body->cvae(part).ptr(),
          .config = config.network,
          .num_samples = static_cast<int64_t>(starts.size()),
          .loss = [=](const learning::Batch& step) -> StatusOr<learning::Loss> {
            const double chance = TeacherChance(step.step, config);
            return CvaeLoss(net, part, samples->train, Choose(starts, step.samples), config,
                            [&] { return step.random.Uniform() < chance; });
          },
          .validate = [=]() -> StatusOr<double> {
            return CvaeLoss(net, part, samples->validation, held_out, config, [] { return false; })
                .terms.at("reconstruction");
          }};
}

NetworkTask SamplerTask(LdpNet net, size_t part, std::shared_ptr<const BodySamples> samples,
                        const BodyTraining& config) {
  LearnOnly(*net, *net->body->sampler(part));
  const std::vector<int64_t> starts = samples->train.Starts(config.rollout);
  const auto held_out = ValidationStarts(samples->validation, config);
  return {.name = fmt::format("sampler{}", part),
          .module = net->body->sampler(part).ptr(),
          .config = config.network,
          .num_samples = static_cast<int64_t>(starts.size()),
          .loss = [=](const learning::Batch& step) -> StatusOr<learning::Loss> {
            return SamplerLoss(net, part, samples->train, Choose(starts, step.samples), config);
          },
          .validate = [=]() -> StatusOr<double> {
            return SamplerLoss(net, part, samples->validation, held_out, config)
                .terms.at("reconstruction");
          }};
}

NetworkTask EndToEndTask(LdpNet net, std::shared_ptr<const LdpTakes> takes,
                         const LdpTraining& config) {
  LearnOnly(*net, *net);
  std::vector<const PushTake*> all = takes->single.train;
  all.insert(all.end(), takes->several.train.begin(), takes->several.train.end());
  const Protocol protocol = *ParseProtocol(config.protocol);
  const auto loss = [=](const learning::Batch& step) mutable -> StatusOr<learning::Loss> {
    const std::vector<const PushTake*> chosen = Choose(all, step.samples);
    learning::Loss loss{.total = torch::zeros({}), .terms = {{"joints_m", 0}, {"states", 0}}};
    for (const bool multi : {false, true}) {
      std::vector<const PushTake*> group;
      std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(group),
                   [&](const PushTake* take) { return take->multi == multi; });
      if (group.empty()) continue;
      const double share = static_cast<double>(group.size()) / static_cast<double>(chosen.size());
      const LdpBatch batch = MakeLdpBatch(group, net->body->parts(), protocol, step.random);
      LdpForecast forecast = net->Forecast(batch);
      const Tensor joints = JointError(forecast, batch);
      const auto frames = batch.takes.frames();
      PendulumTensors& states = forecast.crowd.states;
      states = {states.position.slice(2, 0, frames), states.velocity.slice(2, 0, frames),
                states.rod.slice(2, 0, frames)};
      const CrowdErrors errors = ErrorsOf(forecast.crowd, batch.takes);
      loss.total = loss.total + share * (config.end_to_end.joint_weight * joints +
                                         CrowdLoss(errors, config.balance_training));
      loss.terms["joints_m"] += share * joints.item<double>();
      loss.terms["states"] += share * errors.states.item<double>();
    }
    return loss;
  };
  return {.name = "end_to_end",
          .module = net.ptr(),
          .config = config.end_to_end.network,
          .num_samples = static_cast<int64_t>(all.size()),
          .loss = loss,
          .validate = [=]() -> StatusOr<double> {
            return (JointErrorOn(net, takes->single.validation, protocol) +
                    JointErrorOn(net, takes->several.validation, protocol)) /
                   2;
          }};
}

double JointErrorOn(LdpNet net, const std::vector<const PushTake*>& takes, Protocol protocol) {
  const torch::NoGradGuard no_gradient;
  base::Random noise(kValidationSeed);
  const LdpBatch batch = MakeLdpBatch(takes, net->body->parts(), protocol, noise);
  return JointError(net->Forecast(batch), batch).item<double>();
}

}  // namespace poise::push::ldp
