#include "core/api/push_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace poise::api {
namespace {

Status CheckPerson(const PushPerson& person, const std::string& field) {
  if (!(person.mass_kg > 0 && person.mass_kg <= PushSpec::kMaxMass)) {
    return base::InvalidArgument("BAD_MASS", field + ".mass_kg",
                                 fmt::format("{}: mass is {} kg, expected above 0 and at most {}",
                                             field, person.mass_kg, PushSpec::kMaxMass));
  }
  constexpr double kFarthest = 1e5;  // [m]
  const auto near = [](double value) { return std::abs(value) <= kFarthest; };
  if (person.place && !(near(person.place->x()) && near(person.place->z()))) {
    return base::InvalidArgument(
        "BAD_PLACE", field + ".place",
        fmt::format("{}: place is ({}, {}) m, expected finite and within {} m of the origin", field,
                    person.place->x(), person.place->z(), kFarthest));
  }
  if (person.frame < 0) {
    return base::InvalidArgument("FRAME_OUT_OF_RANGE", field + ".frame",
                                 fmt::format("{}: frame is {}", field, person.frame));
  }
  return absl::OkStatus();
}

Status CheckForce(const PushForce& push, const std::string& field) {
  const double impulse = push.impulse_ns.norm();
  if (!(impulse <= PushSpec::kMaxImpulse) || push.impulse_ns.y() != 0) {
    return base::InvalidArgument(
        "BAD_FORCE", field + ".impulse_ns",
        fmt::format("{}: impulse is ({}, {}, {}) N s, expected finite, horizontal and at most {} "
                    "N s",
                    field, push.impulse_ns.x(), push.impulse_ns.y(), push.impulse_ns.z(),
                    PushSpec::kMaxImpulse));
  }
  if (!(push.height >= 0 && push.height <= 2)) {
    return base::InvalidArgument(
        "BAD_FORCE", field + ".height",
        fmt::format("{}: height is {}, expected 0 (ankles) to 2, 1 is the hip", field,
                    push.height));
  }
  return absl::OkStatus();
}

Status CheckTime(const PushForce& push, double duration_s, const std::string& field) {
  if (push.start_s >= 0 && push.duration_s > 0 && push.start_s + push.duration_s <= duration_s) {
    return absl::OkStatus();
  }
  return base::InvalidArgument(
      "PUSH_OUTSIDE_CLIP", field + ".start_s",
      fmt::format("{}: lasts from {} s for {} s, expected inside the clip of {} s", field,
                  push.start_s, push.duration_s, duration_s));
}

}  // namespace

std::string PushSpec::IdOf(int person) const {
  return people[person].id.empty() ? std::to_string(person) : people[person].id;
}

Status CheckDistances(const std::vector<motion::Vec3>& places) {
  std::vector<int> by_x(places.size());
  std::iota(by_x.begin(), by_x.end(), 0);
  std::sort(by_x.begin(), by_x.end(), [&](int a, int b) { return places[a].x() < places[b].x(); });
  for (size_t i = 0; i < by_x.size(); ++i) {
    for (size_t j = i + 1; j < by_x.size(); ++j) {
      const motion::Vec3 between = places[by_x[j]] - places[by_x[i]];
      if (between.x() >= PushSpec::kMinDistance) break;
      const double distance = std::hypot(between.x(), between.z());
      if (distance >= PushSpec::kMinDistance) continue;
      const auto [first, second] = std::minmax(by_x[i], by_x[j]);
      return base::InvalidArgument(
          "OVERLAPPING_PEOPLE", fmt::format("people[{}].place", second),
          fmt::format("people {} and {} stand {:.3f} m apart, expected at least {} m", first,
                      second, distance, PushSpec::kMinDistance));
    }
  }
  return absl::OkStatus();
}

Status PushSpec::Validate() const {
  const auto refuse = [](const char* reason, const char* field, const std::string& message) {
    return base::InvalidArgument(reason, field, message);
  };
  if (people.empty()) return refuse("NO_PEOPLE", "people", "people is empty: nobody to push");
  if (people.size() > kMaxPeople) {
    return refuse("TOO_MANY_PEOPLE", "people",
                  fmt::format("scene has {} people, at most {}", people.size(), kMaxPeople));
  }
  if (pushes.size() > kMaxPushes) {
    return refuse("TOO_MANY_PUSHES", "pushes",
                  fmt::format("scene has {} pushes, at most {}", pushes.size(), kMaxPushes));
  }
  if (!(duration_s > 0 && duration_s <= kMaxDuration)) {
    return refuse(
        "BAD_DURATION", "duration_s",
        fmt::format("duration is {} s, expected above 0 and at most {}", duration_s, kMaxDuration));
  }
  std::set<std::string> ids;
  for (size_t i = 0; i < people.size(); ++i) {
    const std::string field = fmt::format("people[{}]", i);
    POISE_RETURN_IF_ERROR(CheckPerson(people[i], field));
    if (!ids.insert(IdOf(static_cast<int>(i))).second) {
      return base::InvalidArgument("DUPLICATE_ID", field + ".id",
                                   fmt::format("two people have the id '{}'", IdOf(i)));
    }
  }
  for (size_t i = 0; i < pushes.size(); ++i) {
    const std::string field = fmt::format("pushes[{}]", i);
    if (pushes[i].person < 0 || pushes[i].person >= static_cast<int>(people.size())) {
      return base::InvalidArgument("UNKNOWN_PERSON", field + ".person",
                                   fmt::format("{}: person {} is not in the scene of {} people",
                                               field, pushes[i].person, people.size()));
    }
    POISE_RETURN_IF_ERROR(CheckForce(pushes[i], field));
    POISE_RETURN_IF_ERROR(CheckTime(pushes[i], duration_s, field));
  }
  return absl::OkStatus();
}

}  // namespace poise::api
