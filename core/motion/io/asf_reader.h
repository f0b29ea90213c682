#ifndef POISE_CORE_MOTION_IO_ASF_READER_H_
#define POISE_CORE_MOTION_IO_ASF_READER_H_

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/motion/skeleton.h"

namespace poise::motion {

/// One number of a bone's AMC line.
struct AsfDof {
  bool is_position = false;
  int axis = 0;  ///< 0 = x, 1 = y, 2 = z
};

/// A bone; the root is bone 0. Units: those of the file, angles in radians.
struct AsfBone {
  std::string name;
  int parent = -1;
  Vec3 direction = Vec3::Zero();  ///< in the world, at rest
  double length = 0;
  Quat axis = Quat::Identity();  ///< C: from the bone's dof axes to the world, at rest
  math::EulerOrder rotation_order{{2, 1, 0}};  ///< of M, as its product is written: Rz Ry Rx
  std::vector<AsfDof> dofs;                    ///< in the order of its AMC line
  int line = 0;                                ///< where the file names it
};

/// An Acclaim skeleton, parents first.
struct AsfSkeleton {
  std::vector<AsfBone> bones;
  Vec3 root_position = Vec3::Zero();  ///< added to the root's translation
  double length_unit = 1;             ///< the number behind `length` in :units
  bool degrees = true;

  /// A joint where each bone begins, named by the bone; a bone that no other continues ends in an
  /// end site.
  std::vector<Joint> Joints() const;
};

/// Reads an ASF file. Errors: kInvalidArgument MALFORMED_ASF, DUPLICATE_JOINT, TOO_LARGE, with the
/// line: a bone without parent or with two, a cycle, an unknown name, a number that is none.
StatusOr<AsfSkeleton> ReadAsf(std::string_view file, std::string_view data);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_ASF_READER_H_
