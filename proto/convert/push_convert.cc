#include "proto/convert/push_convert.h"

#include <fmt/format.h>

#include <utility>

#include "proto/convert/clip_convert.h"
#include "proto/convert/utf8.h"

namespace poise::convert {
namespace {

v1::PushPerson ToProto(const api::PushPerson& person) {
  v1::PushPerson message;
  message.set_id(ValidUtf8(person.id));
  if (person.body) *message.mutable_body() = convert::ToProto(*person.body);
  message.set_frame(person.frame);
  message.set_mass_kg(person.mass_kg);
  if (person.place) *message.mutable_place() = convert::ToProto(*person.place);
  return message;
}

StatusOr<api::PushPerson> FromProto(const v1::PushPerson& message) {
  api::PushPerson person{.id = message.id(),
                         .body = std::nullopt,
                         .frame = message.frame(),
                         .mass_kg = message.mass_kg(),
                         .place = std::nullopt};
  if (message.has_place()) person.place = convert::FromProto(message.place());
  if (message.has_body()) {
    POISE_ASSIGN_OR_RETURN(person.body, convert::FromProto(message.body()));
  }
  return person;
}

v1::PushForce ToProto(const api::PushForce& push) {
  v1::PushForce message;
  message.set_person(push.person);
  message.set_start_s(push.start_s);
  message.set_duration_s(push.duration_s);
  *message.mutable_impulse_ns() = convert::ToProto(push.impulse_ns);
  message.set_height(push.height);
  return message;
}

api::PushForce FromProto(const v1::PushForce& message) {
  api::PushForce push{.person = message.person(),
                      .start_s = message.start_s(),
                      .duration_s = message.duration_s(),
                      .height = message.has_height() ? message.height() : 1};
  if (message.has_force_n()) {
    push.impulse_ns = convert::FromProto(message.force_n()) * message.duration_s();
  } else {
    push.impulse_ns = convert::FromProto(message.impulse_ns());
  }
  return push;
}

template <typename Repeated>
void Assign(const std::array<double, 4>& values, Repeated* out) {
  out->Assign(values.begin(), values.end());
}

template <typename Repeated>
Status Read(const Repeated& values, const char* field, std::array<double, 4>& out) {
  if (values.size() != 4) {
    return base::InvalidArgument("WRONG_SHAPE", field,
                                 fmt::format("{} has {} values, expected 4", field, values.size()));
  }
  std::copy(values.begin(), values.end(), out.begin());
  return absl::OkStatus();
}

v1::PushPersonFrame ToProto(const api::PushPersonFrame& person) {
  v1::PushPersonFrame message;
  *message.mutable_root_position() = convert::ToProto(person.root_position);
  message.mutable_rotations()->Reserve(static_cast<int>(4 * person.rotations.size()));
  for (const motion::Quat& q : person.rotations) {
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) {
      message.add_rotations(static_cast<float>(value));
    }
  }
  Assign(person.pendulum, message.mutable_pendulum());
  Assign(person.pendulum_rate, message.mutable_pendulum_rate());
  message.set_rod_m(person.rod_m);
  *message.mutable_hip() = convert::ToProto(person.hip);
  Assign(person.interaction_force, message.mutable_interaction_force());
  if (person.onset_s) message.set_onset_s(*person.onset_s);
  return message;
}

StatusOr<api::PushPersonFrame> FromProto(const v1::PushPersonFrame& message) {
  api::PushPersonFrame person{.root_position = convert::FromProto(message.root_position()),
                              .rotations = {},
                              .rod_m = message.rod_m(),
                              .hip = convert::FromProto(message.hip()),
                              .onset_s = std::nullopt};
  if (message.rotations_size() % 4 != 0) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "rotations",
        fmt::format("rotations has {} values, expected four a joint", message.rotations_size()));
  }
  for (int i = 0; i < message.rotations_size(); i += 4) {
    person.rotations.emplace_back(message.rotations(i), message.rotations(i + 1),
                                  message.rotations(i + 2), message.rotations(i + 3));
  }
  POISE_RETURN_IF_ERROR(Read(message.pendulum(), "pendulum", person.pendulum));
  POISE_RETURN_IF_ERROR(Read(message.pendulum_rate(), "pendulum_rate", person.pendulum_rate));
  POISE_RETURN_IF_ERROR(
      Read(message.interaction_force(), "interaction_force", person.interaction_force));
  if (message.has_onset_s()) person.onset_s = message.onset_s();
  return person;
}

}  // namespace

v1::PushForecastRequest ToProto(const api::PushSpec& spec) {
  v1::PushForecastRequest message;
  for (const api::PushPerson& person : spec.people) *message.add_people() = ToProto(person);
  for (const api::PushForce& push : spec.pushes) *message.add_pushes() = ToProto(push);
  message.set_duration_s(spec.duration_s);
  message.set_model(ValidUtf8(spec.model));
  for (const auto& [key, value] : spec.overrides) {
    (*message.mutable_overrides())[ValidUtf8(key)] = ValidUtf8(value);
  }
  return message;
}

StatusOr<api::PushSpec> FromProto(const v1::PushForecastRequest& request) {
  api::PushSpec spec;
  if (request.duration_s() != 0) spec.duration_s = request.duration_s();
  if (!request.model().empty()) spec.model = request.model();
  spec.overrides.insert(request.overrides().begin(), request.overrides().end());
  // Before a million clips are converted only to be refused.
  if (request.people_size() <= api::PushSpec::kMaxPeople &&
      request.pushes_size() <= api::PushSpec::kMaxPushes) {
    for (int i = 0; i < request.people_size(); ++i) {
      StatusOr<api::PushPerson> person = FromProto(request.people(i));
      const std::string field = fmt::format("people[{}]", i);
      if (!person.ok()) return base::Annotate(person.status(), field, field + ".body");
      spec.people.push_back(*std::move(person));
    }
    for (const v1::PushForce& push : request.pushes()) spec.pushes.push_back(FromProto(push));
  } else {
    spec.people.resize(request.people_size());
    spec.pushes.resize(request.pushes_size());
  }
  POISE_RETURN_IF_ERROR(spec.Validate());
  return spec;
}

v1::PushForecastScene ToProto(const api::PushForecastScene& scene) {
  v1::PushForecastScene message;
  message.set_model(ValidUtf8(scene.model));
  message.set_frame_rate(scene.frame_rate);
  message.set_frames(scene.frames);
  for (const api::PushForecastPerson& person : scene.people) {
    v1::PushForecastPerson* out = message.add_people();
    out->set_id(ValidUtf8(person.id));
    out->set_mass_kg(person.mass_kg);
    *out->mutable_skeleton() = ToProto(*person.skeleton);
  }
  return message;
}

StatusOr<api::PushForecastScene> FromProto(const v1::PushForecastScene& message) {
  api::PushForecastScene scene{.model = message.model(),
                               .frame_rate = message.frame_rate(),
                               .frames = message.frames(),
                               .people = {}};
  for (const v1::PushForecastPerson& person : message.people()) {
    POISE_ASSIGN_OR_RETURN(motion::SkeletonPtr skeleton, FromProto(person.skeleton()));
    scene.people.push_back(
        {.id = person.id(), .mass_kg = person.mass_kg(), .skeleton = std::move(skeleton)});
  }
  return scene;
}

v1::PushForecastFrame ToProto(const api::PushForecastFrame& frame) {
  v1::PushForecastFrame message;
  message.set_index(frame.index);
  message.set_time_s(frame.time_s);
  for (const api::PushPersonFrame& person : frame.people) *message.add_people() = ToProto(person);
  return message;
}

StatusOr<api::PushForecastFrame> FromProto(const v1::PushForecastFrame& message) {
  api::PushForecastFrame frame{.index = message.index(), .time_s = message.time_s(), .people = {}};
  for (const v1::PushPersonFrame& person : message.people()) {
    POISE_ASSIGN_OR_RETURN(api::PushPersonFrame out, FromProto(person));
    frame.people.push_back(std::move(out));
  }
  return frame;
}

}  // namespace poise::convert
