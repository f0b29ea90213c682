#include "bench/policy_loop.h"

#include <cmath>
#include <cstdlib>

#include "core/base/random.h"

namespace poise::bench {

std::vector<rl::LayerWeights> RandomLayers(const std::vector<int>& sizes) {
  base::Random random(1);
  std::vector<rl::LayerWeights> layers;
  for (size_t i = 0; i + 1 < sizes.size(); ++i) {
    const float scale = std::sqrt(2.0f / static_cast<float>(sizes[i]));
    const auto draw = [&] { return scale * static_cast<float>(random.Normal()); };
    layers.push_back({Eigen::MatrixXf::NullaryExpr(sizes[i + 1], sizes[i], draw),
                      Eigen::VectorXf::Zero(sizes[i + 1])});
  }
  return layers;
}

PolicyLoop::PolicyLoop(const physics::HumanoidModel& model, const physics::WorldConfig& config,
                       int num_worlds)
    : policy_(*rl::FastMlp::Create(RandomLayers({kObservationSize, 1024, 512, kActionSize}),
                                   rl::Activation::kRelu)),
      value_(*rl::FastMlp::Create(RandomLayers({kObservationSize, 1024, 512, 1}),
                                  rl::Activation::kRelu)),
      observations_(num_worlds * kObservationSize),
      actions_(num_worlds * kActionSize),
      values_(num_worlds) {
  for (int i = 0; i < num_worlds; ++i) {
    worlds_.push_back(std::make_unique<TrackedWorld>(model, config));
  }
}

void PolicyLoop::ControlSteps() {
  const int worlds = static_cast<int>(worlds_.size());
  for (int i = 0; i < worlds; ++i) {
    worlds_[i]->Observe({&observations_[i * kObservationSize], kObservationSize});
  }
  policy_.Forward(observations_, worlds, actions_, scratch_);
  value_.Forward(observations_, worlds, values_, scratch_);
  for (int i = 0; i < worlds; ++i) {
    if (!std::isfinite(values_[i])) std::abort();
    worlds_[i]->ControlStep({&actions_[i * kActionSize], kActionSize});
  }
}

}  // namespace poise::bench
