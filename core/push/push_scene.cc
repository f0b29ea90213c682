#include "core/push/push_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/rest_pose.h"
#include "core/push/restoration/turned_body.h"

namespace poise::push {

StatusOr<ScenePerson> PersonOf(const motion::Clip& clip, int frame,
                               const motion::JointRoles& roles) {
  using motion::JointRole;
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  motion::WorldPoses world;
  motion::ForwardKinematics(clip, frame, 1, world);
  const auto place = [&](JointRole role) {
    return GroundFromWorld(world.position(0, roles.joint(role)));
  };
  const Vec3 hip = place(JointRole::kPelvis);
  const Vec3 right = place(JointRole::kRightAnkle), left = place(JointRole::kLeftAnkle);
  const double height = hip.z() - (right.z() + left.z()) / 2;
  const double least = motion::LegLength(*clip.skeleton(), roles) / 2;
  if (height < least) {
    return base::InvalidArgument(
        "NOT_STANDING", "",
        fmt::format("clip '{}': in frame {} the pelvis is {:.2f} m above the ankles, expected at "
                    "least {:.2f} m of somebody who stands",
                    clip.name(), frame, height, least));
  }
  return ScenePerson{.id = clip.name(),
                     .pendulum = PendulumOf(hip, right, left),
                     .hip = hip,
                     .shape = ShapeOf(clip, frame, roles)};
}

Eigen::Vector2d ForceInFrame(const ScenePush& push, int frame) {
  const int place = frame - push.first_frame;
  if (place < 0 || place >= push.frames) return Eigen::Vector2d::Zero();
  if (!push.recorded_n.empty()) return push.recorded_n[place];
  // The middle of the frame; the sum over the frames is 1 / sin(pi / (2 n)).
  const double half_step = std::numbers::pi / (2 * push.frames);
  const double weight = std::sin((2 * place + 1) * half_step) * std::sin(half_step) * push.frames;
  return weight * push.force_n;
}

}  // namespace poise::push
