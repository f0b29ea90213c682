#ifndef POISE_CORE_API_PUSH_SPEC_H_
#define POISE_CORE_API_PUSH_SPEC_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/api/clip_source.h"
#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::api {

/// Somebody who stands there before the push.
struct PushPerson {
  std::string id;                  ///< empty: the index in the list
  std::optional<ClipSource> body;  ///< absent: an average standing person who faces +X
  int frame = 0;                   ///< of the clip: the pose that the person stands in
  double mass_kg = 75;
  /// Place of the hip on the floor [m]: world x and z. Absent: where the clip has it.
  std::optional<motion::Vec3> place;
};

/// A horizontal push on one person.
struct PushForce {
  int person = 0;
  double start_s = 0;
  double duration_s = 0.2;
  motion::Vec3 impulse_ns = motion::Vec3::Zero();  ///< world; what it does in all, y must be 0
  double height = 1;  ///< where on the body: share of the way from the ankles (0) to the hip (1)
};

/// A request for everybody's motion after pushes.
struct PushSpec {
  static constexpr int kMaxPeople = 1000;
  static constexpr int kMaxPushes = 1000;
  static constexpr double kMaxDuration = 3600;  ///< [s]
  static constexpr double kMaxMass = 500;       ///< [kg]
  static constexpr double kMaxImpulse = 1000;   ///< [N s]
  static constexpr double kMinDistance = 0.2;   ///< [m] of two people's hips

  std::vector<PushPerson> people;
  std::vector<PushForce> pushes;
  double duration_s = 2;
  /// "statue" or a model of the registry; empty: the model that ships, where the server has it.
  std::string model;
  base::Overrides overrides;

  /// What can be said without the clips. Errors: kInvalidArgument NO_PEOPLE, TOO_MANY_PEOPLE,
  /// TOO_MANY_PUSHES, BAD_DURATION, DUPLICATE_ID, BAD_MASS, BAD_PLACE, BAD_FORCE, UNKNOWN_PERSON,
  /// PUSH_OUTSIDE_CLIP, FRAME_OUT_OF_RANGE, with the field.
  Status Validate() const;

  /// The id of a person: as given, else the index.
  std::string IdOf(int person) const;
};

/// Errors: kInvalidArgument OVERLAPPING_PEOPLE when two of these places [m, world, y ignored] are
/// nearer than PushSpec::kMinDistance.
Status CheckDistances(const std::vector<motion::Vec3>& places);

}  // namespace poise::api

#endif  // POISE_CORE_API_PUSH_SPEC_H_
