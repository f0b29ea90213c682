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

  const motion::Vec3& base(int frame) const { return frames_[frame - first_].base; }
  const motion::Vec3& end(int frame) const { return frames_[frame - first_].end; }
  /// The reachable shell of reference sec. 3.5 step 2: [|l1 - l2| + 1 mm, 0.999 (l1 + l2)], less
  /// what the hinge limit takes away.
  Shell ReachableShell(int frame) const;

  /// Solves frame `frame` for the end's position plus `displacement` and writes the rotations of
  /// base, middle and end joint into `variant`. Bones turn by the smallest rotation (no twist); the
  /// end joint keeps its orientation in the world. A target outside the shell is moved to its
  /// surface; where the source itself is outside, the source's radius is the limit, so that a
  /// vanishing displacement changes nothing.
  /// Returns where the end came. Source: reference sec. 3.5.
  motion::Vec3 Displace(int frame, const motion::Vec3& displacement, motion::Clip& variant) const;

 private:
  struct Frame {
    motion::Vec3 base, middle, end;  // world positions
    double upper, lower;             // bone lengths [m]
    double radius;                   // |end - base|
    // Where the middle joint is pushed when the limb is straight; 0 when it is bent anyway.
    motion::Vec3 bend;
    // World from the joint itself and from its parent.
    motion::Quat base_rotation, base_parent;
    motion::Quat middle_rotation, middle_parent;
    motion::Quat end_rotation, end_parent;
  };

  motion::Vec3 ClampToShell(const Frame& frame, const motion::Vec3& target) const;
  motion::Vec3 SolveMiddle(const Frame& frame, const motion::Vec3& target, double displaced,
                           motion::Vec3& end) const;

  Limb limb_;
  int first_;
  bool iterative_;
  bool swung_;
  motion::FabrikOptions fabrik_;
  double max_flexion_cosine_;
  std::vector<Frame> frames_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_LIMB_MOTION_H_
