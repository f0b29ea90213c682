#ifndef POISE_CORE_PUSH_LEARNED_HIP_ENSEMBLE_H_
#define POISE_CORE_PUSH_LEARNED_HIP_ENSEMBLE_H_

#include <vector>

#include "core/push/interaction/body_contact.h"
#include "core/push/learned/push_networks.h"
#include "core/push/learned/reaction_watch.h"
#include "core/push/push_scene.h"

namespace poise::push {

/// Everybody's hip in one frame; rows are people, ground frame.
struct HipMoment {
  int frame = 0;
  FloorVectors path;         // (people, 2) [m] of the hip since frame 0
  FloorVectors rate;         // (people, 2) [m/s]
  FloorVectors lean;         // (people, 2) theta, phi [rad]
  FloorVectors lean_change;  // (people, 2) since a person began, in its heading [rad]
  FloorVectors interaction;  // (people, 2) force of others, at the hip, since the frame before [N]
  Headings headings;         // (people, 2)
  std::vector<bool> takes_part;
  std::vector<int> beginners;
};

/// Moves the hips of a scene frame by frame: the mean of the members, each of which goes its own
/// way. Trunks do not go through each other, whatever the networks say (BodyContact, which keeps
/// momentum). Threads: one caller at a time.
class HipEnsemble {
 public:
  /// Both outlive the ensemble.
  HipEnsemble(const PushScene& scene, const PushNetworks& networks);

  /// The next frame, from frame 0 on.
  HipMoment Next();

 private:
  struct Member {
    HipStates states;
    NeighbourPairs neighbours;
  };

  HipMoment Look();
  void BeginPeople(const HipMoment& now);
  void ApplyPushes(int frame);
  void Step();
  void AddContact(const std::vector<Pair>& pairs, const HipStates& states);

  const PushScene& scene_;
  const PushNetworks& networks_;
  std::vector<Member> members_;
  HipInfluence influence_;
  FloorVectors first_place_;  // (people, 2) of hips in frame 0, from person 0's
  FloorVectors base_lean_;    // (people, 2) when a person began, in its heading
  ReactionWatch watch_;
  NeighbourPairs neighbours_;
  BodyContact contact_;
  FloorVectors interaction_;
  int next_ = 0;
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_HIP_ENSEMBLE_H_
