#ifndef POISE_CORE_PREDICTION_PREDICTOR_H_
#define POISE_CORE_PREDICTION_PREDICTOR_H_

#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/joint_mask.h"

namespace poise::prediction {

/// What a predictor takes and gives. Clips of other bodies and rates are brought into this form and
/// back by forecast.h.
struct PredictorSignature {
  motion::SkeletonPtr skeleton = nullptr;  ///< null: any
  double frame_rate = 0;                   ///< [Hz]; 0: any
  int past_frames = 1;                     ///< [> 0] the last so many are looked at
  int max_future_frames = 0;               ///< 0: any
  bool takes_masks = false;                ///< understands joints that were not seen
};

/// A motion as far as it was observed.
struct Observation {
  motion::Clip past;
  motion::JointMask visible = {};
};

/// The future of motions: one interface for floors and networks, served and evaluated alike.
/// Constant after construction. Threads: Predict may be called from several threads.
class Predictor {
 public:
  virtual ~Predictor() = default;
  virtual const PredictorSignature& signature() const = 0;

  /// The next `future_frames` frames of each motion, on its skeleton and at its rate. One call with
  /// many motions gives what a call for each would, to 1e-5.
  /// Errors: those of CheckObservations; kInternal NOT_FINITE with the motion when the network made
  /// a number that is none; kCancelled, kDeadlineExceeded.
  virtual StatusOr<std::vector<motion::Clip>> Predict(std::span<const Observation> batch,
                                                      int future_frames,
                                                      const base::RunContext& context) const = 0;
};

/// Whether a predictor can answer. Errors: kInvalidArgument TOO_FEW_FRAMES, WRONG_SKELETON,
/// WRONG_FRAME_RATE, WRONG_SHAPE (mask), with the field "observations[i]"; MASKS_NOT_SUPPORTED;
/// HORIZON_TOO_LONG, BAD_HORIZON.
Status CheckObservations(const PredictorSignature& signature, std::span<const Observation> batch,
                         int future_frames);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_PREDICTOR_H_
