#ifndef POISE_CORE_PREDICTION_MIXER_MIXER_PREDICTOR_H_
#define POISE_CORE_PREDICTION_MIXER_MIXER_PREDICTOR_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/mixer/mixer_config.h"
#include "core/prediction/mixer/mixer_kernel.h"
#include "core/prediction/network_body.h"
#include "core/prediction/predictor.h"

namespace poise::prediction {

/// The recommended family, without LibTorch. Everything is predicted relative to the last observed
/// pose, in the tangent space there: a joint's rotation as a rotation vector in its own frame, the
/// root's path in the root's frame. So nothing wraps, where a body stands and faces does not
/// matter, and the network has to say what changes. Source: LTD's DCT coefficients and free
/// matrices between joints (reference sec. 4.2), with perceptrons within joints as MLP-Mixer has
/// them, and on changes of rotation instead of angles.
class MixerPredictor : public Predictor {
 public:
  /// `weights`: parameters and buffers of MixerNet by their names.
  /// Errors: those of TensorFile::Floats.
  static StatusOr<std::shared_ptr<const MixerPredictor>> Create(const MixerConfig& config,
                                                                NetworkBody body,
                                                                const base::TensorFile& weights);

  const PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                              const base::RunContext& context) const override;

 private:
  MixerPredictor(const MixerConfig& config, NetworkBody body);
  Status Load(const base::TensorFile& weights);
  StatusOr<const float*> Take(const base::TensorFile& weights, const std::string& name,
                              std::vector<int64_t> shape);
  StatusOr<MixerLayer> TakeLayer(const base::TensorFile& weights, const std::string& name,
                                 std::vector<int64_t> shape);

  void WriteFeatures(const motion::Clip& past, float* features, float* still) const;
  StatusOr<motion::Clip> Decode(const motion::Clip& past, const float* features,
                                int future_frames) const;

  const NetworkBody body_;
  PredictorSignature signature_;
  MixerArguments arguments_ = {};  // but for the batch
  std::vector<MixerBlock> blocks_;
  std::map<std::string, std::vector<float>> numbers_;  // that the pointers point into
  std::vector<float> scale_;                           // (features)
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_MIXER_MIXER_PREDICTOR_H_
