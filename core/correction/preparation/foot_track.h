#ifndef POISE_CORE_CORRECTION_PREPARATION_FOOT_TRACK_H_
#define POISE_CORE_CORRECTION_PREPARATION_FOOT_TRACK_H_

#include <array>
#include <vector>

#include "core/correction/preparation/preparation_config.h"
#include "core/motion/clip.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

using math::Quat;
using math::Vec3;

/// One foot of the character through a clip.
struct FootTrack {
  int hip = 0, knee = 0, ankle = 0;  ///< bodies, and joints of the clip
  std::array<Vec3, 4> sole;          ///< [m] corners in the ankle's frame
  Vec3 up = Vec3::UnitY();           ///< of the sole, in the ankle's frame
  Vec3 forward = Vec3::UnitZ();      ///< from heel to toe
  std::vector<Vec3> ankles;          ///< (frames) [m]
  std::vector<Quat> rotations;       ///< (frames) world from foot
  std::vector<double> heights;       ///< (frames) [m] of the sole's lowest corner
  std::vector<double> speeds;        ///< (frames) [m/s] of that corner, horizontally
  std::vector<double> rises;         ///< (frames) [m/s] and vertically
  std::vector<char> standing;        ///< (frames) whether it stands; see FindContacts

  int num_frames() const { return static_cast<int>(ankles.size()); }
  Vec3 Corner(int frame, int corner) const {
    return ankles[frame] + rotations[frame] * sole[corner];
  }
};

/// Right, then left; nothing stands yet. `clip` has the character's joints.
std::array<FootTrack, 2> TrackFeet(const motion::Clip& clip, const physics::HumanoidModel& model);

/// (frames) Whether the centre of mass falls freely, or nearly so: then nothing carries the body.
std::vector<char> FindFlight(const motion::Clip& clip, const physics::HumanoidModel& model);

/// Fills `standing` by height and speed of the sole's lowest corner, with hysteresis.
void FindContacts(const std::vector<char>& flight, double frame_rate,
                  const PreparationConfig& config, FootTrack& foot);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_FOOT_TRACK_H_
