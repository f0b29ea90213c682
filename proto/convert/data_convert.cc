#include "proto/convert/data_convert.h"

#include "proto/convert/time_convert.h"
#include "proto/convert/utf8.h"

namespace poise::convert {

v1::DataSet ToProto(const api::DataSet& set) {
  v1::DataSet message;
  message.set_name(set.name);
  message.set_artifact(set.artifact);
  message.set_size_bytes(set.size_bytes);
  message.set_clips(set.clips);
  message.set_frames(set.frames);
  message.set_duration_s(set.duration_s);
  message.mutable_actions()->insert(set.actions.begin(), set.actions.end());
  message.mutable_actors()->insert(set.actors.begin(), set.actors.end());
  message.set_license(ValidUtf8(set.license));
  for (const std::string& note : set.notes) message.add_notes(ValidUtf8(note));
  *message.mutable_create_time() = ToProto(set.create_time);
  return message;
}

api::DataSet FromProto(const v1::DataSet& message) {
  api::DataSet set;
  set.name = message.name();
  set.artifact = message.artifact();
  set.size_bytes = message.size_bytes();
  set.clips = message.clips();
  set.frames = message.frames();
  set.duration_s = message.duration_s();
  set.actions = {message.actions().begin(), message.actions().end()};
  set.actors = {message.actors().begin(), message.actors().end()};
  set.license = message.license();
  set.notes = {message.notes().begin(), message.notes().end()};
  set.create_time = FromProto(message.create_time());
  return set;
}

}  // namespace poise::convert
