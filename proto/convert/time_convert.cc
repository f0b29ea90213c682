#include "proto/convert/time_convert.h"

#include <algorithm>

namespace poise::convert {
namespace {

constexpr absl::Duration kLongest = absl::Seconds(315'576'000'000);

absl::Time Earliest() { return absl::FromUnixSeconds(-62'135'596'800); }
absl::Time Latest() { return absl::FromUnixSeconds(253'402'300'799); }

}  // namespace

google::protobuf::Duration ToProto(absl::Duration duration) {
  duration = std::clamp(duration, -kLongest, kLongest);
  google::protobuf::Duration message;
  message.set_seconds(absl::IDivDuration(duration, absl::Seconds(1), &duration));
  message.set_nanos(static_cast<int32_t>(absl::ToInt64Nanoseconds(duration)));
  return message;
}

absl::Duration FromProto(const google::protobuf::Duration& duration) {
  return absl::Seconds(duration.seconds()) + absl::Nanoseconds(duration.nanos());
}

google::protobuf::Timestamp ToProto(absl::Time time) {
  time = std::clamp(time, Earliest(), Latest());
  google::protobuf::Timestamp message;
  message.set_seconds(absl::ToUnixSeconds(time));
  const absl::Duration rest = time - absl::FromUnixSeconds(message.seconds());
  message.set_nanos(static_cast<int32_t>(absl::ToInt64Nanoseconds(rest)));
  return message;
}

absl::Time FromProto(const google::protobuf::Timestamp& time) {
  return absl::FromUnixSeconds(time.seconds()) + absl::Nanoseconds(time.nanos());
}

}  // namespace poise::convert
