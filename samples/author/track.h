#ifndef POISE_SAMPLES_AUTHOR_TRACK_H_
#define POISE_SAMPLES_AUTHOR_TRACK_H_

#include <functional>
#include <utility>
#include <vector>

#include "core/math/rotation.h"

namespace poise::samples {

/// A quantity over time [s]; degrees for angles, since people write these numbers.
using Channel = std::function<double(double)>;
using VectorChannel = std::function<math::Vec3(double)>;

/// How a track passes a key: without stopping, or coming to rest there (no velocity, no
/// acceleration). Between two equal kRest keys the value does not move at all: a planted foot.
enum class Pass { kThrough, kRest };

template <typename Value>
struct Key {
  double time;  ///< [s]
  Value value;
  Pass pass = Pass::kThrough;
};

/// Hand-set keys joined by quintic Hermite pieces: position, velocity and acceleration are
/// continuous. Velocity and acceleration at a key are those of the parabola through it and its two
/// neighbours, so a key only acts on the four pieces around it. The first and the last key rest,
/// and the value stays theirs outside.
template <typename Value>
class Track {
 public:
  /// Keys in order of time, no two at the same time.
  Track(std::initializer_list<Key<Value>> keys) : Track(std::vector<Key<Value>>(keys)) {}
  explicit Track(std::vector<Key<Value>> keys);

  Value operator()(double time) const;

 private:
  struct Knot {
    double time;
    Value value, velocity, acceleration;
  };
  std::vector<Knot> knots_;
};

using ScalarTrack = Track<double>;
using VectorTrack = Track<math::Vec3>;

extern template class Track<double>;
extern template class Track<math::Vec3>;

}  // namespace poise::samples

#endif  // POISE_SAMPLES_AUTHOR_TRACK_H_
