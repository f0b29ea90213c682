#ifndef POISE_CORE_PUSH_LEARNED_BODY_ENSEMBLE_H_
#define POISE_CORE_PUSH_LEARNED_BODY_ENSEMBLE_H_

#include <vector>

#include "core/push/learned/hip_ensemble.h"
#include "core/push/learned/push_networks.h"
#include "core/push/push_scene.h"

namespace poise::push {

/// Puts bodies on moving hips: the mean of the pose networks, brought to each person's bones, on
/// feet that stand or step (StepPlanner). Who takes no part keeps the pose, once both feet stand.
/// Threads: one caller at a time.
class BodyEnsemble {
 public:
  /// Both outlive the ensemble.
  BodyEnsemble(const PushScene& scene, const PushNetworks& networks);

  /// Goes to the frame `now`; frames come in order. `middle` and `far` are half the lookahead and
  /// the lookahead ahead of it.
  void Step(const HipMoment& now, const HipMoment& middle, const HipMoment& far);

  /// (people) turns of joints since frame 0, ground frame.
  const std::vector<BodyTurns>& turns() const { return turns_; }
  /// (people) of the pelvis since frame 0 [m].
  const Eigen::VectorXf& heights() const { return heights_; }

 private:
  // A person since it last began to react.
  struct Person {
    BodyShape body;                                         // in its heading
    BodyTurns turns;                                        // ground frame
    math::Quat heading;                                     // ground from heading
    Eigen::RowVector2f place = Eigen::RowVector2f::Zero();  // of the hip since frame 0
    float height = 0;
    StepPlanner steps;  // ground frame, from the hip in frame 0
  };

  void Begin(int person, const HipMoment& now);
  MatrixXf Paths(const HipMoment& now, const HipMoment& middle, const HipMoment& far) const;
  void Turn(int person, const Eigen::RowVectorXf& change);
  void PlaceFeet(int person, const HipMoment& now, const Eigen::RowVectorXf& change, bool step);

  const PushScene& scene_;
  const PushNetworks& networks_;
  std::vector<Person> people_;
  MatrixXf bodies_;                 // (people, kBodySize)
  std::vector<MatrixXf> memories_;  // of each member
  std::vector<BodyTurns> turns_;
  Eigen::VectorXf heights_;
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_BODY_ENSEMBLE_H_
