#include "core/push/ldp/forecast_ldp.h"

#include <fmt/format.h>

#include "core/learning/nn/guard.h"
#include "core/learning/nn/module_state.h"
#include "core/learning/nn/trainer.h"
#include "core/push/ldp/ldp_net.h"

namespace poise::push::ldp {
namespace {

using TakeJoints = std::vector<std::vector<Vec3>>;

StatusOr<LdpNet> ReadNet(const artifacts::ModelArtifact& model) {
  if (model.card.family != kFamily) {
    return base::FailedPrecondition(
        "WRONG_FAMILY", "model",
        fmt::format("a model of family '{}', expected {}", model.card.family, kFamily));
  }
  LdpTraining config;
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(model.card.config, config.Fields()));
  LdpNet net(config);
  POISE_RETURN_IF_ERROR(learning::LoadState(model.weights, "", *net));
  net->eval();
  return net;
}

TakeJoints JointsOf(const PushTake& take, const torch::Tensor& forecast) {
  const torch::Tensor joints = forecast.contiguous();
  const auto values = joints.accessor<float, 4>();
  TakeJoints people(take.people.size());
  for (size_t i = 0; i < people.size(); ++i) {
    const Vec3& hip = take.people[i].joint(0, kPelvis);
    for (int frame = 0; frame < take.frames; ++frame) {
      for (int joint = 0; joint < kBodyJoints; ++joint) {
        const auto place = values[static_cast<int64_t>(i)][frame][joint];
        people[i].emplace_back(hip.x() + place[0], hip.y() + place[1], place[2]);
      }
    }
  }
  return people;
}

}  // namespace

StatusOr<std::vector<TakeJoints>> ForecastTakes(const artifacts::ModelArtifact& model,
                                                std::span<const PushTake* const> takes,
                                                Protocol protocol,
                                                const base::RunContext& context) {
  return learning::Guard("forecast pushes", [&]() -> StatusOr<std::vector<TakeJoints>> {
    const torch::NoGradGuard no_gradient;
    POISE_ASSIGN_OR_RETURN(LdpNet net, ReadNet(model));
    learning::SeedTorch(context.seed);
    base::Random random(context.seed);
    std::vector<TakeJoints> forecasts;
    for (const PushTake* take : takes) {
      POISE_RETURN_IF_ERROR(context.Check());
      const LdpBatch batch =
          MakeLdpBatch(std::span(&take, 1), net->body->parts(), protocol, random);
      forecasts.push_back(JointsOf(*take, net->Forecast(batch).joints[0]));
    }
    return forecasts;
  });
}

}  // namespace poise::push::ldp
