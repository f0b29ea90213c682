#ifndef POISE_CORE_PUSH_LDP_LDP_TASKS_H_
#define POISE_CORE_PUSH_LDP_LDP_TASKS_H_

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "core/push/ldp/ldp_net.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/training/train_network.h"

/// What each network of the method learns, and on which takes it chooses its step.
namespace poise::push::ldp {

/// The takes of one training, by their kind.
struct LdpTakes {
  explicit LdpTakes(const TrainingTakes& takes);

  TrainingTakes single, several;
};

/// Balance on takes of one person, interaction on those of several: whole roll-outs.
NetworkTask BalanceTask(LdpNet net, std::shared_ptr<const LdpTakes> takes,
                        const LdpTraining& config);
NetworkTask InteractionTask(LdpNet net, std::shared_ptr<const LdpTakes> takes,
                            const LdpTraining& config);

/// Recorded bodies, normalised. Ours: one set of pose models for single people and for several,
/// where the authors have two.
struct BodySamples {
  BodySamples(LdpNet net, const LdpTakes& takes);

  BodyRows train, validation;
};
NetworkTask CvaeTask(LdpNet net, size_t part, std::shared_ptr<const BodySamples> samples,
                     const BodyTraining& config);
NetworkTask SamplerTask(LdpNet net, size_t part, std::shared_ptr<const BodySamples> samples,
                        const BodyTraining& config);

/// Everything on takes of both kinds.
NetworkTask EndToEndTask(LdpNet net, std::shared_ptr<const LdpTakes> takes,
                         const LdpTraining& config);

/// Mean joint error [m] over takes of one kind, in batches.
double JointErrorOn(LdpNet net, const std::vector<const PushTake*>& takes, Protocol protocol);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_LDP_TASKS_H_
