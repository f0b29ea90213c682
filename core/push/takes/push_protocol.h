#ifndef POISE_CORE_PUSH_TAKES_PUSH_PROTOCOL_H_
#define POISE_CORE_PUSH_TAKES_PUSH_PROTOCOL_H_

#include <string_view>
#include <vector>

#include "core/base/random.h"
#include "core/base/status.h"
#include "core/push/takes/push_take.h"

namespace poise::push {

/// What a model is told about a recorded push. The recorded force is made from the motion to be
/// predicted (reference push.md sec. 2.3), so protocols differ in how much of it they give away.
/// A clip's length is never told.
enum class Protocol {
  kA,  ///< the first D rows of the force, as the paper's program does
  kB,  ///< forward impulse of rows 1 .. D-1 and D alone, spread as a half sine along +X
  kC,  ///< A without row 0, with noise of 10 % on each row
};

/// From "A", "B" or "C". Errors: kInvalidArgument UNKNOWN_PROTOCOL.
StatusOr<Protocol> ParseProtocol(std::string_view name);

/// The push on person 0 as a model may know it.
struct PushInput {
  std::vector<Eigen::Vector2d> force_n;  ///< (D) horizontal, one a frame from frame 0
  /// (D) with the torques that are released beside it; empty where a protocol knows none (B).
  std::vector<GeneralisedForce> generalised;
  double impulse_ns = 0;  ///< forward, rows 1 .. D-1: all protocols know it
};

/// `random` draws protocol C's noise.
PushInput InputOf(const PushTake& take, Protocol protocol, base::Random& random);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TAKES_PUSH_PROTOCOL_H_
