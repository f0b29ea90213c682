#ifndef POISE_PROTO_CONVERT_PLAUSIBILITY_CONVERT_H_
#define POISE_PROTO_CONVERT_PLAUSIBILITY_CONVERT_H_

#include "core/motion/metrics/plausibility.h"
#include "poise/v1/plausibility.pb.h"

namespace poise::convert {

v1::Plausibility ToProto(const motion::Plausibility& plausibility);
/// Nothing to validate: every number is an output.
motion::Plausibility FromProto(const v1::Plausibility& plausibility);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_PLAUSIBILITY_CONVERT_H_
