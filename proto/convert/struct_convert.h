#ifndef POISE_PROTO_CONVERT_STRUCT_CONVERT_H_
#define POISE_PROTO_CONVERT_STRUCT_CONVERT_H_

#include <string>

#include "core/base/json.h"
#include "google/protobuf/struct.pb.h"

namespace poise::convert {

/// A JSON object on the wire. Numbers are doubles there; whole ones come back whole.
google::protobuf::Struct ToProto(const base::Json& object);
/// Keys come back in alphabetical order, so that equal objects look equal. `field` names the object
/// in errors: kInvalidArgument NOT_FINITE.
StatusOr<base::Json> FromProto(const google::protobuf::Struct& message, const std::string& field);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_STRUCT_CONVERT_H_
