#ifndef POISE_CORE_PUSH_LEARNED_HIP_MODEL_H_
#define POISE_CORE_PUSH_LEARNED_HIP_MODEL_H_

#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/base/tensor_file.h"
#include "core/push/interaction/neighbour_pairs.h"
#include "core/push/learned/heading.h"
#include "core/push/learned/hip_config.h"
#include "core/push/learned/network_layers.h"

namespace poise::push {

/// Where everybody's hip is and how it leans, as changes since a person began to react; rows are
/// people, vectors in each person's heading. Lean is theta, phi: phi > 0 leans to the right.
struct HipStates {
  FloorVectors hip, hip_rate;    // (people, 2) [m], [m/s]
  FloorVectors lean, lean_rate;  // (people, 2) [rad], [rad/s]
  MatrixXf memory;               // (people, hidden)

  static HipStates Standing(int people, int hidden);
};

/// What acts on people in one frame; rows are people, vectors in each person's heading.
struct HipInfluence {
  Headings headings;         // (people, 2)
  FloorVectors place;        // (people, 2) [m] of hips when they began, ground frame
  FloorVectors push;         // (people, 2) force / mass [m/s^2]
  MatrixXf context;          // (people, kContextSize)
  FloorVectors contact;      // (people, 2) force / mass [m/s^2] that the network does not know
  Eigen::VectorXf activity;  // (people) [0 to 1] 1: the network moves them; 0: they come to rest

  /// Everybody active, heading along +X, nothing acting.
  static HipInfluence None(int people);
};

/// One trained hip network (training/hip_net.h), which moves everybody frame by frame.
/// Threads: constant and shared.
class HipModel {
 public:
  /// Tensors stand below `prefix`. Errors: those of TensorFile::Floats.
  static StatusOr<HipModel> Read(const base::TensorFile& file, const std::string& prefix,
                                 const HipConfig& config);

  /// Goes from one frame to the next. `pairs` are those whose hips are now within reach. When
  /// `message_effect` is not null it becomes (people, 2), the acceleration [m/s^2] that is there
  /// because of messages: what the network does less what it would do had nobody told it anything.
  void Step(const HipInfluence& influence, const std::vector<Pair>& pairs, HipStates& states,
            FloorVectors* message_effect = nullptr) const;

  const HipConfig& config() const { return config_; }

 private:
  MatrixXf Messages(const HipInfluence& influence, const std::vector<Pair>& pairs,
                    const HipStates& states) const;

  HipConfig config_;
  LinearLayer message_in_, message_out_;
  GruLayer cell_;
  LinearLayer drive_;
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_HIP_MODEL_H_
