#ifndef POISE_CORE_API_AUGMENT_SPEC_H_
#define POISE_CORE_API_AUGMENT_SPEC_H_

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/api/clip_source.h"
#include "core/base/config_fields.h"
#include "core/motion/clip.h"
#include "core/motion/metrics/plausibility.h"

namespace poise::api {

/// How a caller wants its variants.
enum class OutputEncoding {
  kArrays,
  kBvh,  ///< files, in the unit, axes and channels of the source where it was a BVH file
};

/// A request for variants of clips.
struct AugmentSpec {
  static constexpr int kMaxSources = 1000;
  static constexpr int kMaxVariants = 1'000'000;

  std::vector<ClipSource> sources;
  /// Steps joined by '+', applied left to right: "ik", "timewarp", "noise", "mirror", "vae".
  std::string method = "ik+timewarp";
  /// Preset of the IK target region: kick, punch, walk, jog, sneak, grab, deposit or throw.
  std::string action_class = "kick";
  /// The network of step "vae", as NAME or NAME@VERSION.
  std::string model = {};
  /// "recommended" or "paper".
  std::string preset = "recommended";
  int variants_per_source = 10;
  uint64_t seed = 0;
  /// Hyper-parameters by name: {"ik.radius_low": "0.9"}.
  base::Overrides overrides;
  bool with_plausibility = true;
  /// The flow makes clips whatever it says; who hands them out obeys it.
  OutputEncoding output = OutputEncoding::kArrays;

  /// Errors: kInvalidArgument EMPTY_REQUEST, TOO_MANY_SOURCES, BAD_VARIANT_COUNT, UNKNOWN_PRESET.
  /// Method, class and overrides are checked where they are understood (pipeline/augment.h).
  Status Validate() const;
};

/// What IK synthesis did to one variant.
struct IkOutcome {
  motion::JointRole end_effector{};            ///< which joint was moved
  int keyframe = 0;                            ///< frame of the source
  motion::Vec3 target = motion::Vec3::Zero();  ///< [m] world
  double reached_error_m = 0;  ///< distance from the target as asked for to where the joint came
  bool reachable = false;      ///< the target lies in the limb's reachable shell
};

/// One result of an AugmentSpec.
struct Variant {
  int source_index = 0;
  int index = 0;      ///< 0 .. variants_per_source - 1
  uint64_t seed = 0;  ///< of this variant's own random stream
  motion::Clip clip;
  std::optional<IkOutcome> ik;
  std::optional<motion::Plausibility> plausibility;
};

/// A variant as it is handed out: as arrays, as a file, or as the name of an artifact that holds
/// the file (too large for one message).
struct DeliveredVariant {
  int source_index = 0;
  int index = 0;
  uint64_t seed = 0;
  std::variant<motion::Clip, EncodedClip, std::string> result;
  std::optional<IkOutcome> ik;
  std::optional<motion::Plausibility> plausibility;
};

}  // namespace poise::api

#endif  // POISE_CORE_API_AUGMENT_SPEC_H_
