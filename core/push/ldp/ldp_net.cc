#include "core/push/ldp/ldp_net.h"

namespace poise::push::ldp {
namespace {

using torch::Tensor;

void FillJoints(const TakePerson& person, Tensor joints) {
  const Vec3 origin(person.joint(0, kPelvis).x(), person.joint(0, kPelvis).y(), 0);
  auto values = joints.accessor<float, 3>();
  for (int frame = 0; frame < person.frames(); ++frame) {
    for (int joint = 0; joint < kBodyJoints; ++joint) {
      const Vec3 place = person.joint(frame, joint) - origin;
      for (int axis = 0; axis < 3; ++axis) {
        values[frame][joint][axis] = static_cast<float>(place[axis]);
      }
    }
  }
}

}  // namespace

LdpBatch MakeLdpBatch(std::span<const PushTake* const> takes,
                      const std::vector<std::vector<int>>& parts, Protocol protocol,
                      base::Random& random) {
  LdpBatch batch{.takes = MakeTakeTensors(takes, protocol, random), .first = {}, .joints = {}};
  const auto people = batch.takes.people();
  batch.joints = torch::zeros({batch.takes.takes(), people, batch.takes.frames(), kBodyJoints, 3});
  for (const auto& joints : parts) {
    batch.first.push_back(
        torch::zeros({batch.takes.takes() * people, FeatureCount(joints.size())}));
  }
  for (size_t row = 0; row < takes.size(); ++row) {
    const auto take = static_cast<int64_t>(row);
    for (size_t i = 0; i < takes[row]->people.size(); ++i) {
      const TakePerson& person = takes[row]->people[i];
      const auto place = static_cast<int64_t>(i);
      FillJoints(person, batch.joints[take][place]);
      const std::vector<Tensor> features = FirstFeatures(person, parts);
      for (size_t part = 0; part < parts.size(); ++part) {
        batch.first[part][take * people + place].copy_(features[part][0]);
      }
    }
  }
  return batch;
}

LdpNetImpl::LdpNetImpl(const LdpTraining& config)
    : pendulum_(config.pendulum), onset_speed_(config.body.onset_speed) {
  if (pendulum_) {
    crowd = register_module("crowd", CrowdNet(config.balance, config.interaction));
  }
  body = register_module("body", BodyNet(config.body, config.pendulum));
}

LdpForecast LdpNetImpl::Forecast(const LdpBatch& batch) {
  const TakeTensors& takes = batch.takes;
  const auto count = takes.takes(), people = takes.people(), frames = takes.frames();
  LdpForecast forecast;
  BodyDrive drive{.first = batch.first,
                  .pendulum = torch::zeros({count * people, frames, kPendulumFeatures}),
                  .moves = torch::ones({count * people, frames})};
  if (pendulum_) {
    forecast.crowd = crowd->Rollout(takes, frames + 1);
    const PendulumTensors& states = forecast.crowd.states;
    drive.pendulum = PendulumFeatures(states.position, takes.recorded.rod.select(2, 0),
                                      takes.cart_height, takes.hip.select(2, 0).slice(-1, 0, 2))
                         .reshape({count * people, frames, kPendulumFeatures});
    const Tensor speed = states.velocity.slice(-1, 0, 2).square().sum(-1).sqrt();
    const Tensor fast = speed >= onset_speed_;
    Tensor moves = (fast.slice(2, 0, -1) & fast.slice(2, 1)).cumsum(2) > 0;
    moves.select(1, 0).fill_(true);  // the pushed person
    drive.moves = moves.reshape({count * people, frames}).to(torch::kFloat32);
  }
  forecast.joints = body->Rollout(drive).reshape({count, people, frames, kBodyJoints, 3});
  return forecast;
}

Tensor JointError(const LdpForecast& forecast, const LdpBatch& batch) {
  const Tensor distance =
      ((forecast.joints - batch.joints).square().sum(-1) + 1e-10).sqrt().mean(-1).slice(2, 1);
  const Tensor mask = batch.takes.mask.slice(2, 1);
  return ((distance * mask).sum({1, 2}) / mask.sum({1, 2}).clamp_min(1)).mean();
}

}  // namespace poise::push::ldp
