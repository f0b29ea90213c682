#ifndef POISE_CORE_PUSH_PUSH_SCENE_H_
#define POISE_CORE_PUSH_PUSH_SCENE_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"
#include "core/push/pendulum/pendulum.h"
#include "core/push/restoration/rigid_fit.h"

/// What a forecast begins with. Everything here is in the ground frame.
namespace poise::push {

/// A person in frame 0.
struct ScenePerson {
  std::string id;
  double mass_kg = 0;
  PendulumPose pendulum;
  Vec3 hip = Vec3::Zero();
  BodyShape shape{};  ///< its joints, for models that move bodies
};

/// A push: a force at a person's rod during some frames.
struct ScenePush {
  int person = 0;
  int first_frame = 0;
  int frames = 1;                                     ///< [> 0]
  Eigen::Vector2d force_n = Eigen::Vector2d::Zero();  ///< mean over its frames
  double height = 1;                                  ///< share of the rod; 1 is the hip
  /// (frames) [N] when the force of each frame is known; empty: a half sine.
  std::vector<Eigen::Vector2d> recorded_n = {};
};

struct PushScene {
  std::vector<ScenePerson> people;
  std::vector<ScenePush> pushes;
  int frames = 0;  ///< of the forecast, frame 0 included
};

/// The pendulum of a body's pose: hip and ankles by their roles.
/// Errors: kFailedPrecondition MISSING_ROLES; kInvalidArgument NOT_STANDING when the hip is not
/// above the ankles by half the length of a leg.
StatusOr<ScenePerson> PersonOf(const motion::Clip& clip, int frame,
                               const motion::JointRoles& roles);

/// A push's force in a frame: as recorded, or a half sine over its frames (its mean is force_n),
/// which starts and ends softly; zero outside.
Eigen::Vector2d ForceInFrame(const ScenePush& push, int frame);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_PUSH_SCENE_H_
