#ifndef POISE_CORE_MATH_LOW_PASS_H_
#define POISE_CORE_MATH_LOW_PASS_H_

#include <span>

namespace poise::math {

/// Second-order Butterworth low-pass, run forwards and backwards, so that nothing is delayed; the
/// gain at the cutoff is one half. The ends are continued by odd reflection: a constant and a
/// straight line pass unchanged. A cutoff of half the rate or more changes nothing.
void LowPassZeroPhase(std::span<double> values, double rate_hz, double cutoff_hz);

}  // namespace poise::math

#endif  // POISE_CORE_MATH_LOW_PASS_H_
