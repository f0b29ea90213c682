#ifndef POISE_CORE_PUSH_PENDULUM_PENDULUM_H_
#define POISE_CORE_PUSH_PENDULUM_PENDULUM_H_

#include <Eigen/Core>

#include "core/push/ground_frame.h"

/// Each person as an inverted pendulum on a cart: a rod from the middle of the ankles to the hip,
/// which carries most of the mass. Ground frame (Z up); the cart moves horizontally.
/// Coordinates q = (x, y, theta, phi): x, y of the cart [m]; theta > 0 leans the rod to +X, phi > 0
/// to -Y [rad]. The rod length is a parameter that may differ from step to step; terms in its rate
/// are left out, as the paper does.
/// Source: reference push.md sec. 3 and 4; row 3 of C by the Lagrangian (the paper misprints it).
namespace poise::push {

inline constexpr double kGravity = 9.81;      ///< [m/s^2]
inline constexpr double kCartFraction = 0.1;  ///< of a person's mass, in the cart

/// Many pendulums at once: one row a person, so that each coordinate lies together in memory.
using PendulumArray = Eigen::Array<double, Eigen::Dynamic, 4>;
using PersonArray = Eigen::ArrayXd;

/// What does not change during a forecast.
struct PendulumBodies {
  PersonArray mass;         ///< [kg]
  PersonArray cart_height;  ///< [m] above the floor
};

struct PendulumStates {
  PendulumArray position;  ///< (people, 4): x, y, theta, phi
  PendulumArray velocity;  ///< (people, 4): their rates
  PersonArray rod;         ///< [m]
};

/// Generalised accelerations under generalised forces [N, N, N m, N m]: solves
/// M qdd + C + G = force. Preconditions: |theta| below pi/2, mass and rod positive.
PendulumArray Accelerations(const PendulumStates& states, const PersonArray& mass,
                            const PendulumArray& force);

/// The inverse: forces that give these accelerations.
PendulumArray InverseDynamics(const PendulumStates& states, const PersonArray& mass,
                              const PendulumArray& acceleration);

/// Kinetic plus potential energy [J], of each.
PersonArray Energy(const PendulumStates& states, const PersonArray& mass);

/// Horizontal momentum [kg m/s]: (people, 2).
Eigen::ArrayX2d HorizontalMomentum(const PendulumStates& states, const PersonArray& mass);

/// Where the rods end, which is the hip: (people, 3) [m].
Eigen::ArrayX3d RodEnds(const PendulumStates& states, const PersonArray& cart_height);
/// How fast the rod ends move: (people, 3) [m/s].
Eigen::ArrayX3d RodEndVelocities(const PendulumStates& states);

/// Generalised forces of a horizontal force (people, 2) [N] that acts at `height` of the rod (1 =
/// its end, the hip).
PendulumArray AtRod(const PendulumStates& states, const Eigen::ArrayX2d& force,
                    const PersonArray& height);

/// One person's pendulum as the body shows it.
struct PendulumPose {
  Eigen::Vector4d position = Eigen::Vector4d::Zero();
  double rod = 0;
  double cart_height = 0;
};
/// The inverse of RodEnds. Preconditions: the hip is above the ankles.
PendulumPose PendulumOf(const Vec3& hip, const Vec3& right_ankle, const Vec3& left_ankle);
/// As the authors extract it: theta is larger by 1 / cos(phi), so that RodEnds misses the hip by up
/// to a centimetre when the body leans both ways. Released states and forces are made with it.
PendulumPose PaperPendulumOf(const Vec3& hip, const Vec3& right_ankle, const Vec3& left_ankle);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_PENDULUM_PENDULUM_H_
