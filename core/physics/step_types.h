#ifndef POISE_CORE_PHYSICS_STEP_TYPES_H_
#define POISE_CORE_PHYSICS_STEP_TYPES_H_

#include "core/physics/articulation.h"

/// What goes into a step of the simulation and what comes out of it, as plain numbers that the
/// kernels share with World.
namespace poise::physics {

/// Constants of a run.
struct StepSettings {
  double step_s = 1.0 / 600;  ///< between two evaluations of the controller
  int substeps = 1;           ///< of integration and contacts within it
  double gravity[3] = {0, -9.8, 0};
  double friction = 0.81;    ///< of every pair
  double contact_erp = 0.2;  ///< part of a penetration that one substep removes
  double warm_start = 0.85;  ///< part of the last impulse that a contact starts from
  int solver_iterations = 10;
  bool ground = true;
  bool self_collision = true;
  bool conserve_momentum = true;
};

/// One point of contact of the last substep. `other` is -1 for the ground.
struct ContactPoint {
  int body = 0;
  int other = -1;
  int feature = 0;         ///< tells apart the points of one pair
  double point[3] = {};    ///< [m] in the world, on the surface of `body`
  double normal[3] = {};   ///< towards `body`
  double distance = 0;     ///< [m] negative: penetration, before the substep
  double impulse[3] = {};  ///< [N s] on `body`: along the normal, then two tangents
};

/// Controller's wishes during one step.
struct StepDrive {
  const double* target_rotations = nullptr;  ///< (bodies, 4); [0] the root's, in the world
  const double* target_speeds = nullptr;     ///< (speeds)
  const double* target_root = nullptr;       ///< [m] (3)
  /// [N, N m] (speeds) added to the controller's torques; at the root a wrench in world axes.
  const double* feed_forward = nullptr;
  bool predict_bias = true;       ///< gravity and Coriolis in the controller's prediction
  double root_stiffness[2] = {};  ///< [N/m, N m/rad] of the residual wrench; 0 = none
  double root_damping[2] = {};
};

/// The moving part: all that a step reads and writes, so that a copy of it resumes exactly.
struct StepState {
  double root_position[3] = {};
  double rotations[4 * kMaxBodies] = {};
  double speeds[kMaxSpeeds] = {};
  int num_contacts = 0;
  ContactPoint contacts[kMaxContacts];
};

/// What the last step exerted.
struct StepEffort {
  double torques[kMaxSpeeds] = {};  ///< joints, after their limits; 0 at the root
  double residual[6] = {};          ///< [N, N m] force and torque of the residual at the root
  int num_saturated = 0;            ///< joints at their limit
};

struct DynamicsArguments {
  const Articulation* tree;
  const double* rotations;
  const double* speeds;
  const double* accelerations;  ///< null: none
  double gravity[3];
  double* forces;  ///< (speeds) or null
  double* mass;    ///< (speeds, speeds) or null
};

#define POISE_PHYSICS_KERNELS(isa)                                                                \
  namespace isa {                                                                                 \
  void ControlKernel(const Articulation& tree, const StepSettings& settings,                      \
                     const StepDrive& drive, const StepState& state, double* forces,              \
                     StepEffort& effort);                                                         \
  void StepKernel(const Articulation& tree, const StepSettings& settings, const StepDrive& drive, \
                  StepState& state, StepEffort& effort);                                          \
  void DynamicsKernel(const DynamicsArguments& arguments);                                        \
  }
POISE_PHYSICS_KERNELS(isa_v2)
POISE_PHYSICS_KERNELS(isa_v3)
POISE_PHYSICS_KERNELS(isa_v4)
#undef POISE_PHYSICS_KERNELS

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_STEP_TYPES_H_
