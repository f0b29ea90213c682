#ifndef POISE_CORE_PHYSICS_FLOOR_ALIGNMENT_H_
#define POISE_CORE_PHYSICS_FLOOR_ALIGNMENT_H_

#include "core/motion/body_shapes.h"
#include "core/motion/clip.h"

namespace poise::physics {

/// Which of a clip's frames say where the floor is.
enum class FloorRule {
  kLowest,  ///< the lowest corner of the whole clip: nothing penetrates
  kMedian,  ///< the median over frames of the lowest corner: a clip starts with a smaller drop
};

/// Height of the floor in a clip by the character's own foot boxes (not by y = 0 or toe joints,
/// which lie 2 to 3 cm lower and would drop the character at the start). `shapes` must refer to the
/// clip's joints.
double FloorHeight(const motion::Clip& clip, const motion::BodyShapes& shapes, FloorRule rule);

/// The clip moved up or down so that its floor is y = 0.
motion::Clip AlignToFloor(motion::Clip clip, const motion::BodyShapes& shapes, FloorRule rule);

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_FLOOR_ALIGNMENT_H_
