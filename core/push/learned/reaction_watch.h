#ifndef POISE_CORE_PUSH_LEARNED_REACTION_WATCH_H_
#define POISE_CORE_PUSH_LEARNED_REACTION_WATCH_H_

#include <vector>

#include "core/push/interaction/neighbour_pairs.h"
#include "core/push/learned/heading.h"
#include "core/push/push_scene.h"

namespace poise::push {

/// Decides who takes part. The recordings last two seconds and show nobody who has nothing to do
/// with a push, so the networks may move people only from a push that can reach them until shortly
/// after; before and after everybody stands still exactly.
///
/// A person begins when it is pushed, when at that moment it stands in a chain of people within
/// reach of each other that ends at who is pushed, or when somebody comes within reach who moves
/// because of a push that it has not moved for yet (else two people would wake each other for
/// ever). Its heading is then the direction of the push on whom it is nearest to, or that of who
/// came. It comes to rest a while after its own first movement, or after the last movement within
/// reach.
class ReactionWatch {
 public:
  /// `scene` outlives the watch.
  explicit ReactionWatch(const PushScene& scene);

  /// Looks at a frame; frames come in order. `places` (people, 2) [m] of hips, ground frame,
  /// `velocities` (people, 2) [m/s], `pairs` those within reach.
  void Observe(int frame, const FloorVectors& places, const FloorVectors& velocities,
               const std::vector<Pair>& pairs);

  /// Who began in the frame last observed.
  const std::vector<int>& beginners() const { return beginners_; }
  bool takes_part(int person) const { return people_[person].takes_part; }
  /// (people) [0 to 1] how much the network moves them.
  const Eigen::VectorXf& activity() const { return activity_; }
  const Headings& headings() const { return headings_; }
  /// Nobody was within reach when it began.
  bool alone(int person) const { return people_[person].alone; }

 private:
  struct Person {
    bool takes_part = false, has_moved = false, alone = true;
    int stirred = 0;  // frame of the last reason to move
    int push = -1;    // that it began for last, in the order of their beginnings
  };

  void Begin(int person, int frame, int push, const Eigen::RowVector2f& heading, bool alone);
  void SpreadPushes(int frame, const FloorVectors& places, const std::vector<Pair>& pairs);
  void SpreadMovement(int frame, const FloorVectors& velocities, const std::vector<Pair>& pairs);
  void ComeToRest(int frame, const FloorVectors& velocities);

  const PushScene& scene_;
  std::vector<Person> people_;
  std::vector<int> beginners_;
  Eigen::VectorXf activity_;
  Headings headings_;
  int pushes_ = 0;  // moments in which pushes began
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_REACTION_WATCH_H_
