#ifndef POISE_CORE_PUSH_EVALUATION_ANCHORS_H_
#define POISE_CORE_PUSH_EVALUATION_ANCHORS_H_

#include <filesystem>
#include <map>

#include "core/base/status.h"
#include "core/push/evaluation/take_scores.h"

/// Forecasts that need no learning, to stand beside every number (reference push.md sec. 11.3).
namespace poise::push {

/// A path of one person's hip: (frames) [m].
using HipPath = std::vector<Vec3>;

/// Everybody keeps the pose of frame 0 and is moved along the path of the hip.
ForecastJoints Statue(const PushTake& take, const std::vector<HipPath>& hips);
/// Frame 0 repeated.
ForecastJoints NobodyMoves(const PushTake& take);
/// The recorded hip moves the pose of frame 0.
ForecastJoints StatueOnTrueHip(const PushTake& take);

/// Hips that the authors' pendulums predicted for the test takes, by the name of the take: people
/// alone by released weights, several people as found in released features. Who was predicted not
/// to move, or not yet, keeps the hip of frame 0; the last frame repeats the one before.
/// Errors: those of CsvTable; kInvalidArgument MALFORMED_TAKE.
StatusOr<std::map<std::string, std::vector<HipPath>>> ReadReleasedHips(
    const std::filesystem::path& folder, const std::vector<PushTake>& takes);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_EVALUATION_ANCHORS_H_
