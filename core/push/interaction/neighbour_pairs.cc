#include "core/push/interaction/neighbour_pairs.h"

#include <algorithm>
#include <cmath>

namespace poise::push {
namespace {

// A cell of the grid as one number; columns are far apart, so that neighbours differ by a constant.
constexpr int64_t kColumn = int64_t{1} << 32;

int64_t KeyOf(double x, double y, double size) {
  return static_cast<int64_t>(std::floor(x / size)) * kColumn +
         static_cast<int64_t>(std::floor(y / size));
}

}  // namespace

const std::vector<Pair>& NeighbourPairs::Find(const Eigen::ArrayX2d& places, double radius) {
  const int people = static_cast<int>(places.rows());
  keys_.resize(people);
  cells_.resize(people);
  for (int person = 0; person < people; ++person) {
    keys_[person] = KeyOf(places(person, 0), places(person, 1), radius);
    cells_[person] = {keys_[person], person};
  }
  std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) {
    return a.key != b.key ? a.key < b.key : a.person < b.person;
  });
  pairs_.clear();
  for (int person = 0; person < people; ++person) AddPairs(places, radius, person);
  return pairs_;
}

void NeighbourPairs::AddPairs(const Eigen::ArrayX2d& places, double radius, int person) {
  const size_t begin = pairs_.size();
  for (int column = -1; column <= 1; ++column) {
    // Three cells of a column follow each other.
    const int64_t low = keys_[person] + column * kColumn - 1;
    auto cell = std::lower_bound(cells_.begin(), cells_.end(), low,
                                 [](const Cell& a, int64_t key) { return a.key < key; });
    for (; cell != cells_.end() && cell->key <= low + 2; ++cell) {
      if (cell->person <= person) continue;
      const double x = places(person, 0) - places(cell->person, 0);
      const double y = places(person, 1) - places(cell->person, 1);
      if (x * x + y * y <= radius * radius) pairs_.push_back({person, cell->person});
    }
  }
  std::sort(pairs_.begin() + begin, pairs_.end(),
            [](const Pair& a, const Pair& b) { return a.second < b.second; });
}

}  // namespace poise::push
