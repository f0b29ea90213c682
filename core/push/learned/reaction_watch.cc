#include "core/push/learned/reaction_watch.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/push/body_joints.h"

namespace poise::push {
namespace {

constexpr float kMoving = 0.1f;      // [m/s] as OnsetWatch
constexpr float kAtRest = 0.01f;     // [m/s]
constexpr double kActiveTime = 2.5;  // [s] a little more than the longest recording
constexpr double kCalmingTime = 1;   // [s]

// Sets of people who are joined by pairs.
class Groups {
 public:
  Groups(int people, const std::vector<Pair>& pairs) : parent_(people) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const Pair& pair : pairs) parent_[Find(pair.first)] = Find(pair.second);
  }
  int Find(int person) {
    while (parent_[person] != person) person = parent_[person] = parent_[parent_[person]];
    return person;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

ReactionWatch::ReactionWatch(const PushScene& scene)
    : scene_(scene),
      people_(scene.people.size()),
      activity_(Eigen::VectorXf::Zero(scene.people.size())),
      headings_(FacingX(static_cast<int>(scene.people.size()))) {}

void ReactionWatch::Begin(int person, int frame, int push, const Eigen::RowVector2f& heading,
                          bool alone) {
  Person& begun = people_[person];
  begun.stirred = frame;
  begun.push = push;
  begun.has_moved = false;
  activity_[person] = 1;
  if (begun.takes_part) return;
  begun.takes_part = true;
  begun.alone = alone;
  headings_.row(person) = heading;
  beginners_.push_back(person);
}

void ReactionWatch::SpreadPushes(int frame, const FloorVectors& places,
                                 const std::vector<Pair>& pairs) {
  struct Source {
    int person;
    Eigen::RowVector2f heading;
  };
  std::vector<Source> sources;
  for (const ScenePush& push : scene_.pushes) {
    if (push.first_frame != frame || push.force_n.isZero()) continue;
    sources.push_back({push.person, push.force_n.normalized().cast<float>().transpose()});
  }
  if (sources.empty()) return;
  ++pushes_;
  const int people = static_cast<int>(people_.size());
  Groups groups(people, pairs);
  std::vector<int> sizes(people, 0);
  for (int i = 0; i < people; ++i) ++sizes[groups.Find(i)];
  for (int i = 0; i < people; ++i) {
    const Source* nearest = nullptr;
    float least = std::numeric_limits<float>::max();
    for (const Source& source : sources) {
      if (groups.Find(source.person) != groups.Find(i)) continue;
      const float distance = (places.row(source.person) - places.row(i)).norm();
      if (distance < least) {
        least = distance;
        nearest = &source;
      }
    }
    if (nearest != nullptr) Begin(i, frame, pushes_, nearest->heading, sizes[groups.Find(i)] == 1);
  }
}

void ReactionWatch::SpreadMovement(int frame, const FloorVectors& velocities,
                                   const std::vector<Pair>& pairs) {
  const auto spread = [&](int from, int to) {
    if (!people_[from].takes_part || activity_[from] < 1) return;
    if (velocities.row(from).norm() < kMoving) return;
    const bool rests = !people_[to].takes_part && !people_[to].has_moved;
    if (people_[to].push < people_[from].push || rests) {
      Begin(to, frame, people_[from].push, headings_.row(from), false);
    } else if (!people_[to].has_moved) {
      people_[to].stirred = frame;
    }
  };
  for (const Pair& pair : pairs) {
    spread(pair.first, pair.second);
    spread(pair.second, pair.first);
  }
}

void ReactionWatch::ComeToRest(int frame, const FloorVectors& velocities) {
  for (size_t i = 0; i < people_.size(); ++i) {
    Person& person = people_[i];
    if (!person.takes_part) continue;
    const float speed = velocities.row(i).norm();
    if (!person.has_moved && speed >= kMoving) {
      person.has_moved = true;
      person.stirred = frame;
    }
    const double since = (frame - person.stirred) * kFrameTime;
    activity_[i] = static_cast<float>(
        std::clamp((kActiveTime + kCalmingTime - since) / kCalmingTime, 0.0, 1.0));
    if (activity_[i] == 0 && speed < kAtRest) person.takes_part = false;
  }
}

void ReactionWatch::Observe(int frame, const FloorVectors& places, const FloorVectors& velocities,
                            const std::vector<Pair>& pairs) {
  beginners_.clear();
  SpreadPushes(frame, places, pairs);
  SpreadMovement(frame, velocities, pairs);
  ComeToRest(frame, velocities);
}

}  // namespace poise::push
