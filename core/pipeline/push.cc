#include "core/pipeline/push.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/push/body_joints.h"
#include "core/push/push_scene.h"
#include "core/push/restoration/turned_body.h"
#include "core/push/standing_person.h"

namespace poise::pipeline {
namespace {

using motion::Clip;
using motion::Vec3;

// A person of the scene and the body that a forecast moves.
struct Body {
  push::ScenePerson person;
  Clip clip;  // of one frame: where the person stands
  push::TurnedBody turned;
};

Clip OneFrame(const Clip& clip, int frame, const Vec3& shift) {
  const auto pose = clip.pose(frame);
  return *Clip::Create(clip.name(), clip.skeleton(), push::kFrameRate,
                       {clip.root_position(frame) + shift}, {pose.begin(), pose.end()});
}

// How far the hip must move on the floor to stand where it was asked to.
Vec3 ShiftTo(const std::optional<Vec3>& place, const Vec3& ground_hip) {
  if (!place) return Vec3::Zero();
  const Vec3 hip = push::WorldFromGround(ground_hip);
  return {place->x() - hip.x(), 0, place->z() - hip.z()};
}

StatusOr<Body> PlaceBody(const api::PushPerson& person, const Clip& clip,
                         const motion::JointRoles& roles) {
  if (person.frame >= clip.num_frames()) {
    return base::InvalidArgument("FRAME_OUT_OF_RANGE", "frame",
                                 fmt::format("frame {} of clip '{}', which has {}", person.frame,
                                             clip.name(), clip.num_frames()));
  }
  POISE_ASSIGN_OR_RETURN(push::ScenePerson scene, push::PersonOf(clip, person.frame, roles));
  const Vec3 shift = ShiftTo(person.place, scene.hip);
  const Vec3 ground_shift = push::GroundFromWorld(shift);
  scene.hip += ground_shift;
  scene.pendulum.position.head<2>() += ground_shift.head<2>();
  scene.mass_kg = person.mass_kg;
  Clip standing = OneFrame(clip, person.frame, shift);
  push::TurnedBody turned(standing, roles);
  return Body{std::move(scene), std::move(standing), std::move(turned)};
}

StatusOr<std::vector<Body>> PlaceBodies(const api::PushSpec& spec,
                                        const std::vector<std::optional<ResolvedSource>>& sources) {
  const Clip& standing = push::StandingPerson();
  POISE_ASSIGN_OR_RETURN(const motion::JointRoles standing_roles,
                         motion::JointRoles::Detect(*standing.skeleton()));
  std::vector<Body> bodies;
  std::vector<Vec3> places;
  for (size_t i = 0; i < spec.people.size(); ++i) {
    const auto& source = sources[i];
    StatusOr<Body> body = PlaceBody(spec.people[i], source ? source->clip : standing,
                                    source ? source->roles : standing_roles);
    const std::string field = fmt::format("people[{}]", i);
    if (!body.ok()) return base::Annotate(body.status(), field, field);
    body->person.id = spec.IdOf(static_cast<int>(i));
    places.push_back(push::WorldFromGround(body->person.hip));
    bodies.push_back(*std::move(body));
  }
  POISE_RETURN_IF_ERROR(api::CheckDistances(places));
  return bodies;
}

push::ScenePush ToScene(const api::PushForce& force) {
  const int frames =
      std::max(1, static_cast<int>(std::lround(force.duration_s * push::kFrameRate)));
  const Vec3 ground = push::GroundFromWorld(force.impulse_ns);
  return {.person = force.person,
          .first_frame = static_cast<int>(std::lround(force.start_s * push::kFrameRate)),
          .frames = frames,
          .force_n = ground.head<2>() * push::kFrameRate / frames,
          .height = force.height};
}

template <typename Row>
std::array<double, 4> ToArray(const Row& row) {
  return {row(0), row(1), row(2), row(3)};
}

}  // namespace

class PushFlow::Implementation {
 public:
  Implementation(const api::PushSpec& spec, std::vector<Body> bodies, const std::string& model,
                 const push::PushForecaster& forecaster)
      : bodies_(std::move(bodies)) {
    push::PushScene scene;
    scene.frames = static_cast<int>(std::lround(spec.duration_s * push::kFrameRate)) + 1;
    for (const Body& body : bodies_) {
      scene.people.push_back(body.person);
      info_.people.push_back(
          {.id = body.person.id, .mass_kg = body.person.mass_kg, .skeleton = body.clip.skeleton()});
    }
    for (const api::PushForce& force : spec.pushes) scene.pushes.push_back(ToScene(force));
    info_.model = model;
    info_.frame_rate = push::kFrameRate;
    info_.frames = scene.frames;
    rollout_ = forecaster.Start(scene);
  }

  const api::PushForecastScene& info() const { return info_; }

  StatusOr<api::PushForecastFrame> Next(const base::RunContext& context) {
    POISE_RETURN_IF_ERROR(context.Check());
    POISE_ASSIGN_OR_RETURN(const push::PushFrame* frame, rollout_->Next());
    api::PushForecastFrame out{
        .index = frame->frame, .time_s = frame->frame * push::kFrameTime, .people = {}};
    out.people.reserve(bodies_.size());
    for (size_t i = 0; i < bodies_.size(); ++i) out.people.push_back(PersonIn(*frame, i));
    return out;
  }

 private:
  api::PushPersonFrame PersonIn(const push::PushFrame& frame, size_t i) const {
    const Body& body = bodies_[i];
    const Vec3 hip = frame.hips.row(i).matrix().transpose();
    const auto pose = body.clip.pose(0);
    api::PushPersonFrame person{
        .root_position = body.clip.root_position(0) + push::WorldFromGround(hip - body.person.hip),
        .rotations = {pose.begin(), pose.end()},
        .pendulum = ToArray(frame.states.position.row(i)),
        .pendulum_rate = ToArray(frame.states.velocity.row(i)),
        .rod_m = frame.states.rod[i],
        .hip = push::WorldFromGround(hip),
        .interaction_force = ToArray(frame.interaction.row(i)),
        .onset_s = std::nullopt};
    if (!frame.turns.empty()) {
      person.root_position = body.turned.RootPosition(frame.turns[i], person.hip);
      person.rotations = body.turned.Rotations(frame.turns[i]);
    }
    if (frame.onset_frames[i] >= 0) person.onset_s = frame.onset_frames[i] * push::kFrameTime;
    return person;
  }

  std::vector<Body> bodies_;
  api::PushForecastScene info_;
  std::unique_ptr<push::PushRollout> rollout_;
};

PushFlow::PushFlow(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
PushFlow::~PushFlow() = default;

StatusOr<std::unique_ptr<PushFlow>> PushFlow::Create(
    const api::PushSpec& spec, std::vector<std::optional<ResolvedSource>> bodies,
    const std::string& model, const push::PushForecaster& forecaster) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  POISE_ASSIGN_OR_RETURN(std::vector<Body> placed, PlaceBodies(spec, bodies));
  return std::unique_ptr<PushFlow>(
      new PushFlow(std::make_unique<Implementation>(spec, std::move(placed), model, forecaster)));
}

const api::PushForecastScene& PushFlow::scene() const { return implementation_->info(); }

StatusOr<api::PushForecastFrame> PushFlow::Next(const base::RunContext& context) {
  return implementation_->Next(context);
}

}  // namespace poise::pipeline
