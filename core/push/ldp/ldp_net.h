#ifndef POISE_CORE_PUSH_LDP_LDP_NET_H_
#define POISE_CORE_PUSH_LDP_LDP_NET_H_

#include <torch/torch.h>

#include <span>
#include <vector>

#include "core/push/ldp/body_net.h"
#include "core/push/ldp/crowd_net.h"
#include "core/push/ldp/ldp_config.h"

namespace poise::push::ldp {

/// Takes for the whole method. All of one person, or all of several.
struct LdpBatch {
  TakeTensors takes;
  std::vector<torch::Tensor> first;  ///< FirstFeatures of each part: (takes * people, features)
  /// (takes, people, frames, kBodyJoints, 3) [m] recorded, as LdpForecast's.
  torch::Tensor joints;
};
LdpBatch MakeLdpBatch(std::span<const PushTake* const> takes,
                      const std::vector<std::vector<int>>& parts, Protocol protocol,
                      base::Random& random);

struct LdpForecast {
  CrowdPaths crowd;  ///< a frame longer than the take; empty without pendulums
  /// (takes, people, frames, kBodyJoints, 3) [m], each person from its hip of frame 0 on the floor.
  torch::Tensor joints;
};

/// The whole method: pendulums, and the bodies on them.
class LdpNetImpl : public torch::nn::Module {
 public:
  explicit LdpNetImpl(const LdpTraining& config);

  /// Of a batch frame 0, masses and push are looked at.
  LdpForecast Forecast(const LdpBatch& batch);

  CrowdNet crowd{nullptr};
  BodyNet body{nullptr};

 private:
  const bool pendulum_;
  const double onset_speed_;
};
TORCH_MODULE(LdpNet);

/// Mean over takes of the mean joint error [m] over people and frames 1..
torch::Tensor JointError(const LdpForecast& forecast, const LdpBatch& batch);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_LDP_NET_H_
