#include "core/prediction/ensemble/ensemble_predictor.h"

#include <utility>

namespace poise::prediction {
namespace {

using motion::Clip;
using motion::Quat;

// Adds a clip to sums of positions and of quaternions, which lie on the side of the first clip's.
void Add(const Clip& clip, Clip& sum) {
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    sum.root_position(frame) += clip.root_position(frame);
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      Quat& total = sum.rotation(frame, joint);
      const Quat& one = clip.rotation(frame, joint);
      total.coeffs() += (total.dot(one) < 0 ? -1.0 : 1.0) * one.coeffs();
    }
  }
}

}  // namespace

std::shared_ptr<const EnsemblePredictor> EnsemblePredictor::Create(
    std::vector<std::shared_ptr<const Predictor>> members) {
  return std::shared_ptr<const EnsemblePredictor>(new EnsemblePredictor(std::move(members)));
}

StatusOr<std::vector<Clip>> EnsemblePredictor::Predict(std::span<const Observation> batch,
                                                       int future_frames,
                                                       const base::RunContext& context) const {
  POISE_ASSIGN_OR_RETURN(std::vector<Clip> means,
                         members_.front()->Predict(batch, future_frames, context));
  for (size_t member = 1; member < members_.size(); ++member) {
    POISE_ASSIGN_OR_RETURN(const std::vector<Clip> futures,
                           members_[member]->Predict(batch, future_frames, context));
    for (size_t i = 0; i < futures.size(); ++i) Add(futures[i], means[i]);
  }
  for (Clip& mean : means) {
    for (int frame = 0; frame < mean.num_frames(); ++frame) {
      mean.root_position(frame) /= static_cast<double>(members_.size());
      for (int joint = 0; joint < mean.num_joints(); ++joint)
        mean.rotation(frame, joint).normalize();
    }
  }
  return means;
}

}  // namespace poise::prediction
