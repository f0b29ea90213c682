#ifndef POISE_CORE_PUSH_LEARNED_HIP_MODEL_H_
#define POISE_CORE_PUSH_LEARNED_HIP_MODEL_H_

#include <vector>

#include "core/base/status.h"
#include "core/base/tensor_file.h"
#include "core/push/interaction/neighbour_pairs.h"
#include "core/push/learned/hip_config.h"
#include "core/push/learned/network_layers.h"

namespace poise::push {

/// Where everybody's hip is and how it leans, as changes since frame 0; rows are people.
struct HipStates {
  MatrixXf hip, hip_rate;    // (people, 2) [m], [m/s]
  MatrixXf lean, lean_rate;  // (people, 2) [rad], [rad/s]
  MatrixXf memory;           // (people, hidden)

  static HipStates Standing(int people, int hidden);
};

/// One trained hip network (training/hip_net.h), which moves everybody frame by frame.
/// Threads: constant and shared.
class HipModel {
 public:
  /// Tensors stand below `prefix`. Errors: those of TensorFile::Floats.
  static StatusOr<HipModel> Read(const base::TensorFile& file, const std::string& prefix,
                                 const HipConfig& config);

  /// Goes from one frame to the next. Shapes: place (people, 2) [m] of the hips in frame 0; push
  /// (people, 2) force / mass [m/s^2]; context (people, kContextSize); `pairs` those whose hips are
  /// now within reach.
  void Step(const MatrixXf& place, const MatrixXf& push, const MatrixXf& context,
            const std::vector<Pair>& pairs, HipStates& states) const;

  const HipConfig& config() const { return config_; }

 private:
  MatrixXf Messages(const MatrixXf& place, const std::vector<Pair>& pairs,
                    const HipStates& states) const;

  HipConfig config_;
  LinearLayer message_in_, message_out_;
  GruLayer cell_;
  LinearLayer drive_;
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_HIP_MODEL_H_
