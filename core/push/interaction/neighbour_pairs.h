#ifndef POISE_CORE_PUSH_INTERACTION_NEIGHBOUR_PAIRS_H_
#define POISE_CORE_PUSH_INTERACTION_NEIGHBOUR_PAIRS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace poise::push {

/// Two people who are near each other; first < second.
struct Pair {
  int first = 0;
  int second = 0;
};

/// Finds who is near whom on the floor, in time proportional to people and pairs.
/// Threads: one caller at a time; memory is reused from call to call.
class NeighbourPairs {
 public:
  /// All pairs not farther apart than `radius` [m, > 0], ordered by first, then second. `places`
  /// (people, 2) [m]; valid until the next call.
  const std::vector<Pair>& Find(const Eigen::ArrayX2d& places, double radius);

 private:
  struct Cell {
    int64_t key;
    int person;
  };

  void AddPairs(const Eigen::ArrayX2d& places, double radius, int person);

  std::vector<int64_t> keys_;  // (people)
  std::vector<Cell> cells_;    // sorted by key
  std::vector<Pair> pairs_;
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_INTERACTION_NEIGHBOUR_PAIRS_H_
