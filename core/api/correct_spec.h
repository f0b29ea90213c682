#ifndef POISE_CORE_API_CORRECT_SPEC_H_
#define POISE_CORE_API_CORRECT_SPEC_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/api/clip_source.h"
#include "core/base/config_fields.h"
#include "core/base/json.h"

namespace poise::api {

/// A request for variants of clips that a simulated body has imitated: the parameters of a job of
/// kind "correct". Everything random comes from the job's seed.
struct CorrectSpec {
  static constexpr int kMaxSources = 1000;
  static constexpr int kMaxVariants = 1'000'000;

  std::vector<ClipSource> sources;
  /// "none" corrects the clips as they are; else steps as in AugmentSpec: "ik", "ik+timewarp".
  std::string method = "ik";
  /// Preset of the IK target region, as in AugmentSpec.
  std::string action_class = "kick";
  /// The network of step "vae", for the record: NAME@VERSION.
  std::string model = {};
  /// The network itself, "artifacts/<sha256>": the same whatever the name comes to mean.
  std::string model_artifact = {};
  /// The network that undoes the character's habits, likewise; empty: none.
  std::string debias = {};
  std::string debias_artifact = {};
  /// [0 to kMaxVariants] 0: 1 with the method none, else 20. With none no more than 1.
  int variants_per_source = 0;
  /// How hard each correction tries: instant (no learning) | fast (a few rollouts) | full (a policy
  /// is learned first).
  std::string effort = "fast";
  /// recommended | paper (as MotionAug did), of the method and the correction.
  std::string preset = "recommended";
  /// What holds the body beside its muscles: none | rfc (learned) | pd (on the pelvis' error) |
  /// pd_rfc (both).
  std::string residual = "pd";
  double max_seconds = 0;   ///< [s] of work, then what is there is the result; 0: no limit
  double body_mass_kg = 0;  ///< [kg] 5 to 500; 0: the preset's
  /// Hyper-parameters by name: of the correction ("learning.rollouts") and, where the name begins
  /// with a step of the method, of that ("ik.radius_low").
  base::Overrides overrides;

  /// The number of variants that is meant.
  int Variants() const;

  /// What can be said without the flow's own tables. Errors: kInvalidArgument EMPTY_REQUEST,
  /// TOO_MANY_SOURCES, BAD_VARIANT_COUNT, CONFIG_VALUE_OUT_OF_RANGE, MALFORMED_CONFIG_VALUE, with
  /// the field; RESIDUAL_NEEDS_LEARNING when an effort without learning is to learn a force.
  Status Validate() const;

  /// All but sources and overrides.
  std::vector<base::Field> Fields();

  /// {"sources": [{"artifact", "name", "format", "skeleton_data", "unit_m", "up", "frame_rate",
  /// "joint_roles"}], "method", ..., "overrides": {}}; of a source only artifact and name must be
  /// there. Sources are StoredClips. Errors of FromJson: those of Validate; kInvalidArgument
  /// UNKNOWN_CONFIG_KEY, MALFORMED_SOURCE, UNKNOWN_FORMAT, BAD_HINT.
  base::Json ToJson() const;
  static StatusOr<CorrectSpec> FromJson(const base::Json& json);
};

}  // namespace poise::api

#endif  // POISE_CORE_API_CORRECT_SPEC_H_
