#ifndef POISE_PROTO_CONVERT_MODEL_CONVERT_H_
#define POISE_PROTO_CONVERT_MODEL_CONVERT_H_

#include "core/api/model_card.h"
#include "core/base/status.h"
#include "poise/v1/model.pb.h"

namespace poise::convert {

v1::MotionSignature ToProto(const motion::MotionSignature& signature);
/// Errors: as motion::SignatureFromJson.
StatusOr<motion::MotionSignature> FromProto(const v1::MotionSignature& signature);

v1::ModelCard ToProto(const api::ModelCard& card);
/// Keys of config and normalisation come back in alphabetical order. Errors: those of the parts.
StatusOr<api::ModelCard> FromProto(const v1::ModelCard& card);

v1::Model ToProto(const api::Model& model);
StatusOr<api::Model> FromProto(const v1::Model& model);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_MODEL_CONVERT_H_
