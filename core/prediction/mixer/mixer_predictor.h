#ifndef POISE_CORE_PREDICTION_MIXER_MIXER_PREDICTOR_H_
#define POISE_CORE_PREDICTION_MIXER_MIXER_PREDICTOR_H_

#include <memory>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/mixer/mixer_config.h"
#include "core/prediction/mixer/mixer_kernel.h"
#include "core/prediction/network/network_predictor.h"

namespace poise::prediction {

/// The recommended family, without LibTorch. Everything is predicted relative to the last observed
/// pose, in the tangent space there: a joint's rotation as a rotation vector in its own frame, the
/// root's path in the root's frame. So nothing wraps, where a body stands and faces does not
/// matter, and the network has to say what changes. Source: LTD's DCT coefficients and free
/// matrices between joints (reference sec. 4.2), with perceptrons within joints as MLP-Mixer has
/// them, and on changes of rotation instead of angles.
class MixerPredictor : public NetworkPredictor {
 public:
  /// `weights`: parameters and buffers of MixerNet by their names.
  /// Errors: those of TensorFile::Floats.
  static StatusOr<std::shared_ptr<const MixerPredictor>> Create(const MixerConfig& config,
                                                                NetworkBody body,
                                                                const base::TensorFile& weights);

 private:
  MixerPredictor(const MixerConfig& config, NetworkBody body);
  Status Load(const base::TensorFile& weights);

  Sizes sizes() const override;
  void Encode(const motion::Clip& past, float* inputs) const override;
  void Forward(int batch, const float* inputs, float* outputs) const override;
  void Decode(const motion::Clip& past, const float* outputs, FuturePoses& future) const override;

  NetworkWeights numbers_;
  MixerArguments arguments_ = {};  // but for the batch
  std::vector<MixerBlock> blocks_;
  std::vector<float> scale_;  // (features)
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_MIXER_MIXER_PREDICTOR_H_
