#ifndef POISE_CORE_PREDICTION_ZERO_VELOCITY_ZERO_VELOCITY_H_
#define POISE_CORE_PREDICTION_ZERO_VELOCITY_ZERO_VELOCITY_H_

#include "core/prediction/predictor.h"

namespace poise::prediction {

/// The floor: the last observed pose is held. Over short horizons it beats many networks.
class ZeroVelocity : public Predictor {
 public:
  const PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                              const base::RunContext& context) const override;

 private:
  PredictorSignature signature_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_ZERO_VELOCITY_ZERO_VELOCITY_H_
