#ifndef POISE_CORE_SYNTHESIS_IK_LIMB_MOTION_H_
#define POISE_CORE_SYNTHESIS_IK_LIMB_MOTION_H_

#include <vector>

#include "core/motion/clip.h"
#include "core/motion/kinematics/fabrik.h"
#include "core/synthesis/ik/ik_config.h"
#include "core/synthesis/ik/limb.h"

namespace poise::synthesis {

/// Distances from the limb's base at which its end can be.
struct Shell {
  double inner = 0;  ///< [m]
  double outer = 0;  ///< [m]
  bool Contains(double radius) const { return inner <= radius && radius <= outer; }
};

/// One limb over some frames of a clip, with everything worked out that does not depend on where
/// its end is to go: displacing the end then touches three rotations of a frame and nothing else.
/// Constant after construction.
class LimbMotion {
 public:
  /// `bend_direction` as BendDirection gives it. Frames [first, first + count).
  LimbMotion(const motion::Clip& clip, const Limb& limb, const motion::Vec3& bend_direction,
             int first, int count, const IkConfig& config);

  const motion::Vec3& base(int frame) const { return At(frame).base; }
  const motion::Vec3& end(int frame) const { return At(frame).end; }
  /// The reachable shell of reference sec. 3.5 step 2: [|l1 - l2| + 1 mm, 0.999 (l1 + l2)], less
  /// what the hinge limit takes away.
  Shell ReachableShell(int frame) const { return ShellOf(At(frame)); }

  /// What is to happen at the keyframe, in the terms in which it is spread over time.
  struct Edit {
    motion::Vec3 displacement = motion::Vec3::Zero();  ///< [m] of the end, as asked for
    motion::Vec3 swing = motion::Vec3::Zero();  ///< [rad] rotation vector of the line base to end
    double flexion = 0;                         ///< [rad] change, in the coordinate of SoftFlexion
  };
  /// `target` for the end at `keyframe`. A target outside the shell is meant for its surface; where
  /// the source itself is outside, the source's radius is the limit, so that asking for the place
  /// where the end is changes nothing.
  Edit Plan(int keyframe, const motion::Vec3& target) const;

  /// Applies `weight` times the edit to frame `frame` and writes the rotations of base, middle and
  /// end joint into `variant`. Bones turn by the smallest rotation (no twist); the end joint keeps
  /// its orientation in the world. Returns where the end came. Source: reference sec. 3.4, 3.5.
  motion::Vec3 Apply(int frame, double weight, const Edit& edit, motion::Clip& variant) const;

 private:
  struct Frame {
    motion::Vec3 base, middle, end;  // world positions
    double upper, lower;             // bone lengths [m]
    double radius;                   // |end - base|
    double flexion;                  // [rad] 0 when the limb is straight
    // Where the middle joint is pushed when the limb is straight; 0 when it is bent anyway.
    motion::Vec3 bend;
    // From the middle joint to where it would be on the side on which it was over some time.
    motion::Vec3 steady;
    // World from the joint itself and from its parent.
    motion::Quat base_rotation, base_parent;
    motion::Quat middle_rotation, middle_parent;
    motion::Quat end_rotation, end_parent;
  };

  const Frame& At(int frame) const { return frames_[frame - first_]; }
  Shell ShellOf(const Frame& frame) const;
  double ClampToShell(const Frame& frame, double radius) const;
  motion::Vec3 SpreadPosition(const Frame& frame, double weight, const Edit& edit) const;
  motion::Vec3 SpreadLimb(const Frame& frame, double weight, const Edit& edit) const;
  void SteadyBendPlane(double frame_rate);
  motion::Vec3 SolveMiddle(const Frame& frame, const motion::Vec3& target, double weight,
                           motion::Vec3& end) const;

  Limb limb_;
  int first_;
  bool iterative_;
  bool swung_;
  bool spread_limb_;
  motion::FabrikOptions fabrik_;
  double max_flexion_;
  std::vector<Frame> frames_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_LIMB_MOTION_H_
