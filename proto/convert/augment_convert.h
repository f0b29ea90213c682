#ifndef POISE_PROTO_CONVERT_AUGMENT_CONVERT_H_
#define POISE_PROTO_CONVERT_AUGMENT_CONVERT_H_

#include "core/api/augment_spec.h"
#include "core/base/status.h"
#include "poise/v1/augmentation.pb.h"

namespace poise::convert {

v1::OutputEncoding ToProto(api::OutputEncoding output);
/// Errors: kInvalidArgument UNKNOWN_OUTPUT.
StatusOr<api::OutputEncoding> FromProto(v1::OutputEncoding output);

v1::AugmentRequest ToProto(const api::AugmentSpec& spec);
/// Absent fields take the defaults of AugmentSpec. Errors: those of AugmentSpec::Validate and of
/// each source (field "sources[2].clip.rotations"), kInvalidArgument UNKNOWN_OUTPUT.
StatusOr<api::AugmentSpec> FromProto(const v1::AugmentRequest& request);

v1::IkOutcome ToProto(const api::IkOutcome& outcome);
/// Errors: kInvalidArgument UNKNOWN_ROLE.
StatusOr<api::IkOutcome> FromProto(const v1::IkOutcome& outcome);

v1::AugmentResponse ToProto(const api::DeliveredVariant& variant);
/// Errors: kInvalidArgument EMPTY_RESULT, those of the clip and of the outcome.
StatusOr<api::DeliveredVariant> FromProto(const v1::AugmentResponse& response);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_AUGMENT_CONVERT_H_
