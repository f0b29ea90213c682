#ifndef POISE_CORE_API_PREDICT_QUERY_H_
#define POISE_CORE_API_PREDICT_QUERY_H_

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/api/augment_spec.h"
#include "core/api/clip_source.h"
#include "core/motion/joint_mask.h"

namespace poise::api {

/// What comes next in a motion?
struct PredictQuery {
  static constexpr double kMaxHorizon = 60;  ///< [s]
  static constexpr int kMaxSamples = 100;

  ClipSource source;                    ///< its last seconds are looked at
  std::string model = "zero-velocity";  ///< "NAME" (the newest) or "NAME@VERSION"
  double horizon_s = 0.4;               ///< [s, > 0] how far to look ahead
  motion::JointMask visible = {};       ///< which joints of which frames were seen
  int samples = 1;    ///< futures wanted; a deterministic model gives one whatever is asked
  uint64_t seed = 0;  ///< of models that draw
  OutputEncoding output = OutputEncoding::kArrays;

  /// Errors: kInvalidArgument BAD_MODEL_NAME (empty), BAD_HORIZON, BAD_SAMPLE_COUNT.
  Status Validate() const;
};

/// The answer: futures on the source's skeleton and at its rate.
struct Forecast {
  std::string model;
  std::string version;
  std::vector<double> frame_times_s;  ///< (frames) after the last observed frame
  std::vector<std::variant<motion::Clip, EncodedClip>> futures;
  bool deterministic = true;
  bool inpainted = false;  ///< joints that were not seen have been filled in
};

/// How a stream of forecasts begins: whose frames will come.
struct ForecastStreamSpec {
  std::string model = "zero-velocity";
  double horizon_s = 0.4;  ///< [s, > 0]
  motion::SkeletonPtr skeleton;
  double frame_rate = 0;  ///< [Hz, > 0]
  motion::RoleOverrides joint_roles = {};

  /// Errors: kInvalidArgument BAD_MODEL_NAME, BAD_HORIZON, BAD_FRAME_RATE.
  Status Validate() const;
};

}  // namespace poise::api

#endif  // POISE_CORE_API_PREDICT_QUERY_H_
