#ifndef POISE_PROTO_CONVERT_PUSH_CONVERT_H_
#define POISE_PROTO_CONVERT_PUSH_CONVERT_H_

#include "core/api/push_forecast.h"
#include "core/api/push_spec.h"
#include "core/base/status.h"
#include "poise/v1/push.pb.h"

/// Pushes and what people do after them, between the wire and memory.
namespace poise::convert {

v1::PushForecastRequest ToProto(const api::PushSpec& spec);
/// Errors: those of PushSpec::Validate and of the clips, with the field.
StatusOr<api::PushSpec> FromProto(const v1::PushForecastRequest& request);

v1::PushForecastScene ToProto(const api::PushForecastScene& scene);
/// Errors: kInvalidArgument, those of Skeleton::Create.
StatusOr<api::PushForecastScene> FromProto(const v1::PushForecastScene& scene);

/// Rotations lose their last bits: single precision on the wire.
v1::PushForecastFrame ToProto(const api::PushForecastFrame& frame);
/// Errors: kInvalidArgument WRONG_SHAPE.
StatusOr<api::PushForecastFrame> FromProto(const v1::PushForecastFrame& frame);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_PUSH_CONVERT_H_
