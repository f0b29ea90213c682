#ifndef POISE_CORE_LEARNING_NN_TRAINER_STATE_H_
#define POISE_CORE_LEARNING_NN_TRAINER_STATE_H_

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "core/base/tensor_file.h"
#include "core/learning/nn/network_optimizer.h"
#include "core/learning/nn/trainer.h"

namespace poise::learning {

/// Sums of what was measured since the last row of the curve.
struct TermSums {
  std::map<std::string, double> sums;
  int64_t count = 0;

  void Add(const std::map<std::string, double>& terms, std::string_view network);
  std::map<std::string, double> Means() const;
};

/// Everything that changes while a trainer trains, and its way into a checkpoint and back.
struct TrainerState {
  TrainingReport report;
  LearningCurve curve;
  TermSums recent;
  int failed_validations = 0;  ///< in a row
  /// Parameters and buffers of the best validation, "NETWORK/NAME"; empty before the first one.
  base::TensorFile best;
};

/// The state of all networks as "NETWORK/NAME".
StatusOr<base::TensorFile> ReadNetworks(const std::vector<TrainedNetwork>& networks);
Status WriteNetworks(const base::TensorFile& file, std::vector<TrainedNetwork>& networks);

/// `identity` names all that a resumed run must have in common with the interrupted one.
StatusOr<std::string> EncodeCheckpoint(const TrainerState& state, const base::Json& identity,
                                       const std::vector<TrainedNetwork>& networks,
                                       const std::vector<NetworkOptimizer>& optimizers);
/// Errors: as Trainer::Restore.
StatusOr<TrainerState> DecodeCheckpoint(std::string_view bytes, const base::Json& identity,
                                        std::vector<TrainedNetwork>& networks,
                                        std::vector<NetworkOptimizer>& optimizers);

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_TRAINER_STATE_H_
