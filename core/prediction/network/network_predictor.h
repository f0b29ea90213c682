#ifndef POISE_CORE_PREDICTION_NETWORK_NETWORK_PREDICTOR_H_
#define POISE_CORE_PREDICTION_NETWORK_NETWORK_PREDICTOR_H_

#include <vector>

#include "core/prediction/network/network_weights.h"
#include "core/prediction/network_body.h"
#include "core/prediction/predictor.h"

namespace poise::prediction {

/// The frames that a network predicts; at first its body's last observed pose again and again.
struct FuturePoses {
  int joints = 0;
  std::vector<motion::Vec3> root_positions;  ///< (frames)
  std::vector<motion::Quat> rotations;       ///< (frames, joints)

  int num_frames() const { return static_cast<int>(root_positions.size()); }
  motion::Quat& rotation(int frame, int joint) {
    return rotations[static_cast<size_t>(frame) * joints + joint];
  }
};

/// What all networks that are served without LibTorch have in common: motions become numbers, one
/// forward pass takes them all, and its numbers become motions.
class NetworkPredictor : public Predictor {
 public:
  const PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                              const base::RunContext& context) const override;

 protected:
  NetworkPredictor(NetworkBody body, int past_frames, int future_frames);

  /// Numbers per motion that the forward pass takes and gives.
  struct Sizes {
    size_t inputs = 0, outputs = 0;
  };
  virtual Sizes sizes() const = 0;
  /// Of the end of `past`. Shape: inputs (sizes().inputs)
  virtual void Encode(const motion::Clip& past, float* inputs) const = 0;
  /// Shapes: inputs (batch, sizes().inputs), outputs (batch, sizes().outputs)
  virtual void Forward(int batch, const float* inputs, float* outputs) const = 0;
  /// Of which `future` may have fewer frames than the network predicts.
  virtual void Decode(const motion::Clip& past, const float* outputs,
                      FuturePoses& future) const = 0;

  const NetworkBody& body() const { return body_; }

 private:
  StatusOr<motion::Clip> ToClip(const motion::Clip& past, const float* outputs,
                                int future_frames) const;

  const NetworkBody body_;
  const PredictorSignature signature_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_NETWORK_NETWORK_PREDICTOR_H_
