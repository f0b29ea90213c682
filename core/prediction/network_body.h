#ifndef POISE_CORE_PREDICTION_NETWORK_BODY_H_
#define POISE_CORE_PREDICTION_NETWORK_BODY_H_

#include <vector>

#include "core/base/json.h"
#include "core/motion/dataset/benchmark_clips.h"
#include "core/motion/motion_signature.h"
#include "core/motion/skeleton.h"

namespace poise::prediction {

/// Whose motion a network predicts: what its card must say beside its sizes.
struct NetworkBody {
  motion::SkeletonPtr skeleton;
  double frame_rate = 0;    ///< [Hz]
  std::vector<int> joints;  ///< that it predicts, ascending, without the root; others are held

  /// Joints of which a column counts. Precondition: the benchmark has clips.
  static NetworkBody Of(const motion::BenchmarkClips& clips);

  /// The same in the words of model cards: the roles that its joints play.
  motion::MotionSignature Signature() const;

  base::Json ToJson() const;
  /// Errors: kInvalidArgument MALFORMED_CARD, those of SkeletonFromJson.
  static StatusOr<NetworkBody> FromJson(const base::Json& json);
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_NETWORK_BODY_H_
