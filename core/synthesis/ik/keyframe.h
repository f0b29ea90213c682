#ifndef POISE_CORE_SYNTHESIS_IK_KEYFRAME_H_
#define POISE_CORE_SYNTHESIS_IK_KEYFRAME_H_

#include <optional>
#include <vector>

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"
#include "core/synthesis/ik/ik_config.h"
#include "core/synthesis/ik/limb.h"

namespace poise::synthesis {

/// Where the joints that choose the keyframe are, in the world.
/// Shapes: (frames) each; a side that is no candidate is empty
struct EndEffectorTracks {
  double frame_rate = 0;
  std::vector<motion::Vec3> pelvis;
  std::vector<motion::Vec3> right;
  std::vector<motion::Vec3> left;
};

EndEffectorTracks TrackEndEffectors(const motion::Clip& clip, int pelvis,
                                    const std::optional<Limb>& right,
                                    const std::optional<Limb>& left);

struct Keyframe {
  int frame = 0;
  Side side = Side::kRight;
};

/// The frame at which a clip is edited, and the active side among the candidates.
/// Rule `reference`, horizontal distances on a 30 Hz grid: one-sided classes take the frame and the
/// side with the largest distance from the pelvis (the reference mirrors its clips by file name, so
/// that the right side is always the active one); two-sided classes the frame where both are
/// farthest apart, and the side that leads in the pelvis's direction of travel. Rule `paper`: the
/// frame and side with the largest distance from the pelvis, in space and over all frames. A frame
/// given in `config` wins over the rule's.
/// Source: MotionAug sec. 3.2, 4.3; reference sec. 3.2.
Keyframe SelectKeyframe(const EndEffectorTracks& tracks, bool two_sided, const IkConfig& config);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_KEYFRAME_H_
