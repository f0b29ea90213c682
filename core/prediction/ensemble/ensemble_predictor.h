#ifndef POISE_CORE_PREDICTION_ENSEMBLE_ENSEMBLE_PREDICTOR_H_
#define POISE_CORE_PREDICTION_ENSEMBLE_ENSEMBLE_PREDICTOR_H_

#include <memory>
#include <vector>

#include "core/prediction/predictor.h"

namespace poise::prediction {

/// The mean of what several predictors of the same signature say: of positions the mean, of
/// rotations the normalised mean of the quaternions, all on the side of the first member's.
class EnsemblePredictor : public Predictor {
 public:
  /// Precondition: at least one member, all with one signature.
  static std::shared_ptr<const EnsemblePredictor> Create(
      std::vector<std::shared_ptr<const Predictor>> members);

  const PredictorSignature& signature() const override { return members_.front()->signature(); }
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                              const base::RunContext& context) const override;

 private:
  explicit EnsemblePredictor(std::vector<std::shared_ptr<const Predictor>> members)
      : members_(std::move(members)) {}

  const std::vector<std::shared_ptr<const Predictor>> members_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_ENSEMBLE_ENSEMBLE_PREDICTOR_H_
