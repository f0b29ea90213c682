#ifndef POISE_CORE_PUSH_TAKES_PUSH_TAKE_H_
#define POISE_CORE_PUSH_TAKES_PUSH_TAKE_H_

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/motion/clip.h"
#include "core/push/body_joints.h"
#include "core/push/ground_frame.h"

/// Recorded reactions to a push (FZJ Push), alone or in a formation.
namespace poise::push {

/// Generalised force on a pendulum: Fx, Fy [N], Ftheta, Fphi [N m].
using GeneralisedForce = Eigen::Vector4d;

enum class Split { kTrain, kTest };

/// One person of a take.
/// Shapes: joints, rotations (frames, kBodyJoints), frame by frame; ground frame, joints [m]
struct TakePerson {
  std::string file;  ///< below the data set's folder
  std::string suit;  ///< "X07"
  double mass_kg = 0;
  int stated_onset = 0;  ///< frame of the first movement by the data set's rule; -1: never
  std::optional<motion::Clip> clip = std::nullopt;  ///< none in takes from a take file
  std::vector<Vec3> joints = {};
  /// Ground from joint as the file has it: each file's rest pose is another one.
  std::vector<math::Quat> rotations = {};

  int frames() const { return static_cast<int>(joints.size()) / kBodyJoints; }
  const Vec3& joint(int frame, int joint) const { return joints[frame * kBodyJoints + joint]; }
  std::span<const Vec3> pose(int frame) const {
    return {joints.data() + static_cast<size_t>(frame) * kBodyJoints, kBodyJoints};
  }
};

/// One take; everybody has the same number of frames, at kFrameRate.
struct PushTake {
  std::string group;  ///< "X07" (single) or "row_1"
  int index = 0;
  Split split = Split::kTrain;
  bool multi = false;
  std::string session;  ///< single takes: "p" (short pushes) or "m" (long ones)
  std::string level;    ///< single takes: weak, medium, strong
  int frames = 0;
  std::vector<TakePerson> people;  ///< person 0 is pushed
  /// The released force on person 0, one row a frame. Inverse dynamics of the recorded motion, no
  /// sensor (reference sec. 2.3): never more than the first push_frames rows are a push. Several
  /// people have rows for the whole take, for checks.
  std::vector<GeneralisedForce> force;
  int push_frames = 0;  ///< D, after the authors' two corrections

  std::string name() const { return group + "[" + std::to_string(index) + "]"; }
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TAKES_PUSH_TAKE_H_
