#ifndef POISE_CORE_PREDICTION_CONSTANT_VELOCITY_CONSTANT_VELOCITY_H_
#define POISE_CORE_PREDICTION_CONSTANT_VELOCITY_CONSTANT_VELOCITY_H_

#include "core/prediction/predictor.h"

namespace poise::prediction {

/// A floor: the root goes on as it moved, and every joint goes on turning as it turned, between the
/// last two observed frames. Good for a frame or two.
class ConstantVelocity : public Predictor {
 public:
  const PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                              const base::RunContext& context) const override;

 private:
  PredictorSignature signature_{.past_frames = 2};
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_CONSTANT_VELOCITY_CONSTANT_VELOCITY_H_
