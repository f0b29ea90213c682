#ifndef POISE_PROTO_CONVERT_TIME_CONVERT_H_
#define POISE_PROTO_CONVERT_TIME_CONVERT_H_

#include "absl/time/time.h"
#include "google/protobuf/duration.pb.h"
#include "google/protobuf/timestamp.pb.h"

namespace poise::convert {

/// Times and durations on the wire, cut to what it can hold (years 1 to 9999).
google::protobuf::Duration ToProto(absl::Duration duration);
absl::Duration FromProto(const google::protobuf::Duration& duration);
google::protobuf::Timestamp ToProto(absl::Time time);
absl::Time FromProto(const google::protobuf::Timestamp& time);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_TIME_CONVERT_H_
