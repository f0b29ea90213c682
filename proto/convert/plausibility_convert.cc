#include "proto/convert/plausibility_convert.h"

namespace poise::convert {

v1::Plausibility ToProto(const motion::Plausibility& plausibility) {
  v1::Plausibility message;
  message.set_foot_skate_mps(plausibility.foot_skate_mps);
  message.set_penetration_mean_m(plausibility.penetration_mean_m);
  message.set_penetration_max_m(plausibility.penetration_max_m);
  message.set_float_mean_m(plausibility.float_mean_m);
  message.set_self_penetration_max_m(plausibility.self_penetration_max_m);
  message.set_acceleration_rms_mps2(plausibility.acceleration_rms_mps2);
  message.set_jerk_rms_mps3(plausibility.jerk_rms_mps3);
  return message;
}

motion::Plausibility FromProto(const v1::Plausibility& plausibility) {
  motion::Plausibility value;
  value.foot_skate_mps = plausibility.foot_skate_mps();
  value.penetration_mean_m = plausibility.penetration_mean_m();
  value.penetration_max_m = plausibility.penetration_max_m();
  value.float_mean_m = plausibility.float_mean_m();
  value.self_penetration_max_m = plausibility.self_penetration_max_m();
  value.acceleration_rms_mps2 = plausibility.acceleration_rms_mps2();
  value.jerk_rms_mps3 = plausibility.jerk_rms_mps3();
  return value;
}

}  // namespace poise::convert
