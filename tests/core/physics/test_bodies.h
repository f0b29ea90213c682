#ifndef POISE_TESTS_CORE_PHYSICS_TEST_BODIES_H_
#define POISE_TESTS_CORE_PHYSICS_TEST_BODIES_H_

#include "core/base/random.h"
#include "core/physics/humanoid_model.h"
#include "core/physics/state.h"

namespace poise::physics {

/// The humanoid of the test skeleton (tests/support/test_clips.h), feet flat on the ground.
HumanoidModelPtr TestHumanoid(const HumanoidConfig& config = {});

/// Random joint angles up to about a radian and speeds up to `speed`; rigid joints stay.
State RandomState(const Articulation& tree, base::Random& random, double speed);

/// A fixed base and one body on a ball joint, 0.5 m below it, with no motor.
Articulation Pendulum();

}  // namespace poise::physics

#endif  // POISE_TESTS_CORE_PHYSICS_TEST_BODIES_H_
