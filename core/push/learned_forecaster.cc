#include <cmath>
#include <deque>
#include <memory>
#include <utility>

#include "core/push/learned/body_ensemble.h"
#include "core/push/learned/hip_ensemble.h"
#include "core/push/learned/push_networks.h"
#include "core/push/onset_watch.h"
#include "core/push/push_forecaster.h"

namespace poise::push {
namespace {

using NetworksPtr = std::shared_ptr<const PushNetworks>;

class LearnedRollout : public PushRollout {
 public:
  LearnedRollout(const PushScene& scene, NetworksPtr networks)
      : scene_(scene),
        networks_(std::move(networks)),
        hips_(scene_, *networks_),
        bodies_(scene_, *networks_),
        onsets_(static_cast<int>(scene.people.size())) {}

  StatusOr<const PushFrame*> Next() override {
    const int lookahead = networks_->lookahead();
    if (!moments_.empty()) moments_.pop_front();
    while (static_cast<int>(moments_.size()) <= lookahead) moments_.push_back(hips_.Next());
    const HipMoment& now = moments_.front();
    bodies_.Step(now, moments_[lookahead / 2], moments_[lookahead]);
    Describe(now);
    if (!frame_.hips.allFinite() || !frame_.states.position.allFinite()) {
      return base::Internal("NOT_FINITE", "the networks left the range of numbers");
    }
    return &frame_;
  }

 private:
  // The frame as pendulums: hips and lean come from the hip networks, rods from the bodies' height.
  void Describe(const HipMoment& now) {
    const int people = static_cast<int>(scene_.people.size());
    const PendulumArray before = frame_.states.position;
    const Eigen::ArrayX3d hips_before = frame_.hips;
    frame_.frame = now.frame;
    frame_.hips.resize(people, 3);
    frame_.states.position.resize(people, 4);
    frame_.states.rod.resize(people);
    for (int i = 0; i < people; ++i) {
      const ScenePerson& person = scene_.people[i];
      const Vec3 moved(now.path(i, 0), now.path(i, 1), bodies_.heights()[i]);
      const Vec3 hip = person.hip + moved;
      const double theta = now.lean(i, 0), phi = now.lean(i, 1);
      const double rod =
          (hip.z() - person.pendulum.cart_height) / (std::cos(theta) * std::cos(phi));
      frame_.hips.row(i) = hip.transpose().array();
      frame_.states.position.row(i) << hip.x() - rod * std::sin(theta),
          hip.y() + rod * std::cos(theta) * std::sin(phi), theta, phi;
      frame_.states.rod[i] = rod;
    }
    const bool first = before.rows() == 0;
    frame_.states.velocity = first ? PendulumArray(PendulumArray::Zero(people, 4))
                                   : PendulumArray((frame_.states.position - before) * kFrameRate);
    frame_.interaction =
        AtRod(frame_.states, now.interaction.cast<double>().array(), PersonArray::Ones(people));
    onsets_.Observe(now.frame, first ? Eigen::ArrayX3d(Eigen::ArrayX3d::Zero(people, 3))
                                     : Eigen::ArrayX3d((frame_.hips - hips_before) * kFrameRate));
    frame_.onset_frames = onsets_.onset_frames();
    frame_.turns = bodies_.turns();
  }

  const PushScene scene_;
  const NetworksPtr networks_;
  HipEnsemble hips_;
  BodyEnsemble bodies_;
  std::deque<HipMoment> moments_;  // this frame and the lookahead
  OnsetWatch onsets_;
  PushFrame frame_;
};

class LearnedForecaster : public PushForecaster {
 public:
  explicit LearnedForecaster(PushNetworks networks)
      : networks_(std::make_shared<const PushNetworks>(std::move(networks))) {}

  std::unique_ptr<PushRollout> Start(const PushScene& scene) const override {
    return std::make_unique<LearnedRollout>(scene, networks_);
  }

 private:
  const NetworksPtr networks_;
};

}  // namespace

StatusOr<std::unique_ptr<PushForecaster>> MakeLearnedForecaster(
    const artifacts::ModelArtifact& model) {
  POISE_ASSIGN_OR_RETURN(PushNetworks networks, PushNetworks::Read(model));
  return std::make_unique<LearnedForecaster>(std::move(networks));
}

}  // namespace poise::push
