#include "samples/author/track.h"

#include <algorithm>

namespace poise::samples {

template <typename Value>
Track<Value>::Track(std::vector<Key<Value>> keys) {
  for (size_t i = 0; i < keys.size(); ++i) {
    const Value none = keys[i].value * 0.0;
    Knot knot{keys[i].time, keys[i].value, none, none};
    if (i > 0 && i + 1 < keys.size() && keys[i].pass == Pass::kThrough) {
      const double before = keys[i].time - keys[i - 1].time;
      const double after = keys[i + 1].time - keys[i].time;
      const Value slope_before = (keys[i].value - keys[i - 1].value) / before;
      const Value slope_after = (keys[i + 1].value - keys[i].value) / after;
      knot.velocity = (slope_before * after + slope_after * before) / (before + after);
      knot.acceleration = (slope_after - slope_before) * (2 / (before + after));
    }
    knots_.push_back(knot);
  }
}

template <typename Value>
Value Track<Value>::operator()(double time) const {
  const auto next = std::upper_bound(knots_.begin(), knots_.end(), time,
                                     [](double t, const Knot& knot) { return t < knot.time; });
  if (next == knots_.begin()) return knots_.front().value;
  if (next == knots_.end()) return knots_.back().value;
  const Knot& a = *(next - 1);
  const Knot& b = *next;
  const double h = b.time - a.time;
  const double u = (time - a.time) / h;
  // What the start's parabola misses at the end, in position, velocity and acceleration.
  const Value dp = b.value - a.value - a.velocity * h - a.acceleration * (h * h / 2);
  const Value dv = (b.velocity - a.velocity - a.acceleration * h) * h;
  const Value da = (b.acceleration - a.acceleration) * (h * h);
  const Value c3 = dp * 10.0 - dv * 4.0 + da * 0.5;
  const Value c4 = dp * -15.0 + dv * 7.0 - da;
  const Value c5 = dp * 6.0 - dv * 3.0 + da * 0.5;
  return a.value + a.velocity * (u * h) + a.acceleration * (u * u * h * h / 2) +
         (c3 + (c4 + c5 * u) * u) * (u * u * u);
}

template class Track<double>;
template class Track<math::Vec3>;

}  // namespace poise::samples
