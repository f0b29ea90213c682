#ifndef POISE_CORE_PUSH_LEARNED_POSE_MODEL_H_
#define POISE_CORE_PUSH_LEARNED_POSE_MODEL_H_

#include "core/base/status.h"
#include "core/base/tensor_file.h"
#include "core/push/learned/network_layers.h"
#include "core/push/learned/pose_config.h"

namespace poise::push {

/// One trained pose network (training/pose_net.h), frame by frame; rows are people.
/// Threads: constant and shared.
class PoseModel {
 public:
  /// Tensors stand below `prefix`. Errors: those of TensorFile::Floats.
  static StatusOr<PoseModel> Read(const base::TensorFile& file, const std::string& prefix,
                                  const PoseConfig& config);

  /// (people, kPoseSize): change of joints (3 each, joints 1..21 from the pelvis) and of the
  /// pelvis' height since frame 0 [m], probability that feet swing, change of footholds [m]. Bones
  /// are not yet put back to their lengths. `path` (people, kPathSize), `body` (people, kBodySize),
  /// `memory` (people, hidden), at first 0.
  MatrixXf Step(const MatrixXf& path, const MatrixXf& body, MatrixXf& memory) const;

  const PoseConfig& config() const { return config_; }

 private:
  PoseConfig config_;
  GruLayer cell_;
  LinearLayer pose_;
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_POSE_MODEL_H_
