#include "core/push/ldp/pendulum_tensors.h"

#include "core/push/pendulum/pendulum.h"

namespace poise::push::ldp {

using torch::Tensor;

Tensor Accelerations(const PendulumTensors& states, const Tensor& mass, const Tensor& force) {
  const Tensor sines = states.position.slice(-1, 2, 4).sin();
  const Tensor cosines = states.position.slice(-1, 2, 4).cos();
  const Tensor sin_theta = sines.select(-1, 0), sin_phi = sines.select(-1, 1);
  const Tensor cos_theta = cosines.select(-1, 0), cos_phi = cosines.select(-1, 1);
  const Tensor theta_rate = states.velocity.select(-1, 2), phi_rate = states.velocity.select(-1, 3);
  const Tensor bob_rod = (1 - kCartFraction) * mass * states.rod;
  const Tensor weight = kGravity * bob_rod;
  // The entries of M that differ, as core/push/pendulum/pendulum.cc names them.
  const Tensor a = bob_rod * cos_theta, b = bob_rod * sin_theta * sin_phi, d = -a * cos_phi;
  const Tensor i = bob_rod * states.rod, j = i * cos_theta.square();
  const Tensor twist = i * sin_theta * cos_theta;
  // Forces less C + G.
  const Tensor r1 = force.select(-1, 0) + bob_rod * sin_theta * theta_rate.square();
  const Tensor r2 = force.select(-1, 1) -
                    bob_rod * (2 * sin_theta * cos_phi * theta_rate * phi_rate +
                               cos_theta * sin_phi * (theta_rate.square() + phi_rate.square()));
  const Tensor right3 =
      force.select(-1, 2) - twist * phi_rate.square() + weight * sin_theta * cos_phi;
  const Tensor right4 =
      force.select(-1, 3) + 2 * twist * theta_rate * phi_rate + weight * cos_theta * sin_phi;
  // The cart's rows are solved for x and y and put into the other two.
  const Tensor m33 = i - (a.square() + b.square()) / mass;
  const Tensor m34 = -b * d / mass;
  const Tensor m44 = j - d.square() / mass;
  const Tensor r3 = right3 - (a * r1 + b * r2) / mass;
  const Tensor r4 = right4 - d * r2 / mass;
  const Tensor determinant = m33 * m44 - m34.square();
  const Tensor theta = (m44 * r3 - m34 * r4) / determinant;
  const Tensor phi = (m33 * r4 - m34 * r3) / determinant;
  return torch::stack({(r1 - a * theta) / mass, (r2 - b * theta - d * phi) / mass, theta, phi}, -1);
}

Tensor RodEnds(const Tensor& position, const Tensor& rod, const Tensor& cart_height) {
  const Tensor theta = position.select(-1, 2), phi = position.select(-1, 3);
  const Tensor level = rod * theta.cos();
  return torch::stack({position.select(-1, 0) + rod * theta.sin(),
                       position.select(-1, 1) - level * phi.sin(), cart_height + level * phi.cos()},
                      -1);
}

Tensor AtRodEnd(const PendulumTensors& states, const Tensor& force) {
  const Tensor theta = states.position.select(-1, 2), phi = states.position.select(-1, 3);
  const Tensor x = force.select(-1, 0), y = force.select(-1, 1);
  return torch::stack({x, y, states.rod * (x * theta.cos() + y * theta.sin() * phi.sin()),
                       -states.rod * y * theta.cos() * phi.cos()},
                      -1);
}

}  // namespace poise::push::ldp
