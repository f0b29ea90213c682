#include "core/push/learned/hip_ensemble.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/push/body_joints.h"
#include "core/push/learned/push_context.h"

namespace poise::push {
namespace {

// Arms do not brake: the networks learned what people do.
PhysicsConfig TrunksOnly() {
  PhysicsConfig config;
  config.reach_damping = 0;
  return config;
}

FloorVectors FirstPlaces(const PushScene& scene) {
  FloorVectors places(scene.people.size(), 2);
  for (size_t i = 0; i < scene.people.size(); ++i) {
    places.row(i) = (scene.people[i].hip - scene.people[0].hip).head<2>().cast<float>().transpose();
  }
  return places;
}

// theta, phi of the same rod seen along another heading.
Eigen::RowVector2f TurnedLean(const Eigen::RowVector2f& lean, float cosine, float sine) {
  const double theta = lean.x(), phi = lean.y();
  const double x = std::sin(theta), y = -std::cos(theta) * std::sin(phi);
  const double up = std::cos(theta) * std::cos(phi);
  const double forward = cosine * x - sine * y, left = sine * x + cosine * y;
  return {static_cast<float>(std::asin(forward)), static_cast<float>(std::atan2(-left, up))};
}

}  // namespace

HipEnsemble::HipEnsemble(const PushScene& scene, const PushNetworks& networks)
    : scene_(scene),
      networks_(networks),
      influence_(HipInfluence::None(static_cast<int>(scene.people.size()))),
      first_place_(FirstPlaces(scene)),
      base_lean_(scene.people.size(), 2),
      watch_(scene),
      contact_(TrunksOnly(), first_place_.cast<double>().array()),
      interaction_(FloorVectors::Zero(scene.people.size(), 2)) {
  const int people = static_cast<int>(scene.people.size());
  influence_.place = first_place_;
  influence_.activity.setZero();
  for (int i = 0; i < people; ++i) {
    base_lean_.row(i) = scene.people[i].pendulum.position.tail<2>().cast<float>().transpose();
  }
  for (const HipModel& model : networks.hips) {
    members_.push_back({HipStates::Standing(people, model.config().hidden), {}});
  }
}

HipMoment HipEnsemble::Look() {
  const Eigen::Index people = first_place_.rows();
  const auto share = 1 / static_cast<float>(members_.size());
  FloorVectors path = FloorVectors::Zero(people, 2), rate = path, lean = path;
  for (const Member& member : members_) {
    path += share * member.states.hip;
    rate += share * member.states.hip_rate;
    lean += share * member.states.lean;
  }
  HipMoment now{.frame = next_,
                .path = path,
                .rate = rate,
                .lean = lean,
                .lean_change = lean,
                .interaction = interaction_,
                .headings = {},
                .takes_part = {},
                .beginners = {}};
  for (Eigen::Index i = 0; i < people; ++i) {
    const Eigen::RowVector2f heading = influence_.headings.row(i);
    now.path.row(i) =
        influence_.place.row(i) - first_place_.row(i) + ToGround(heading, path.row(i));
    now.rate.row(i) = ToGround(heading, rate.row(i));
    now.lean.row(i) = TurnedLean(base_lean_.row(i) + lean.row(i), heading.x(), heading.y());
  }
  return now;
}

// Who begins starts from where it is now, whatever it did before.
void HipEnsemble::BeginPeople(const HipMoment& now) {
  for (const int i : watch_.beginners()) {
    const Eigen::RowVector2f heading = watch_.headings().row(i);
    influence_.headings.row(i) = heading;
    influence_.place.row(i) = first_place_.row(i) + now.path.row(i);
    base_lean_.row(i) = TurnedLean(now.lean.row(i), heading.x(), -heading.y());
    for (Member& member : members_) {
      HipStates& states = member.states;
      for (FloorVectors* part : {&states.hip, &states.hip_rate, &states.lean, &states.lean_rate}) {
        part->row(i).setZero();
      }
      states.memory.row(i).setZero();
    }
    const auto context = ContextOf({.alone = watch_.alone(i),
                                    .mass_kg = scene_.people[i].mass_kg,
                                    .theta = base_lean_(i, 0),
                                    .phi = base_lean_(i, 1)});
    influence_.context.row(i) = Eigen::Map<const Eigen::RowVectorXf>(context.data(), kContextSize);
  }
}

void HipEnsemble::ApplyPushes(int frame) {
  influence_.push.setZero();
  std::vector<PersonFacts> told(scene_.people.size());  // of pushes that start now
  for (const ScenePush& push : scene_.pushes) {
    const int i = push.person;
    const Eigen::RowVector2f heading = influence_.headings.row(i);
    // What a push does to the hip: its share of the rod.
    const double force_share = push.height / scene_.people[i].mass_kg;
    const Eigen::Vector2d force = force_share * ForceInFrame(push, frame);
    influence_.push.row(i) += FromGround(heading, force.cast<float>().transpose());
    if (push.first_frame != frame) continue;
    const Eigen::Vector2d impulse = push.height * push.frames * kFrameTime * push.force_n;
    told[i].pushed = true;
    told[i].impulse_ns += FromGround(heading, impulse.cast<float>().transpose()).x();
    told[i].push_frames = std::max(told[i].push_frames, push.frames);
  }
  for (size_t i = 0; i < told.size(); ++i) {
    if (!told[i].pushed) continue;
    told[i].alone = watch_.alone(static_cast<int>(i));
    told[i].mass_kg = scene_.people[i].mass_kg;
    told[i].theta = base_lean_(i, 0);
    told[i].phi = base_lean_(i, 1);
    const auto context = ContextOf(told[i]);
    influence_.context.row(i) = Eigen::Map<const Eigen::RowVectorXf>(context.data(), kContextSize);
  }
}

// Adds trunks' forces to the interaction [N] and to what acts on people.
void HipEnsemble::AddContact(const std::vector<Pair>& pairs, const HipStates& states) {
  const Eigen::Index people = first_place_.rows();
  Eigen::ArrayX2d hips(people, 2), force = Eigen::ArrayX2d::Zero(people, 2);
  const Eigen::ArrayX2d still = Eigen::ArrayX2d::Zero(people, 2);
  for (Eigen::Index i = 0; i < people; ++i) {
    hips.row(i) =
        (influence_.place.row(i) + ToGround(influence_.headings.row(i), states.hip.row(i)))
            .cast<double>()
            .array();
  }
  contact_.AddForces(pairs, hips, still, force);
  const auto share = 1 / static_cast<float>(members_.size());
  for (Eigen::Index i = 0; i < people; ++i) {
    const Eigen::RowVector2f own = force.row(i).matrix().cast<float>();
    interaction_.row(i) += share * own;
    influence_.contact.row(i) =
        FromGround(influence_.headings.row(i), own / static_cast<float>(scene_.people[i].mass_kg));
  }
}

void HipEnsemble::Step() {
  const Eigen::Index people = first_place_.rows();
  const auto share = 1 / static_cast<float>(members_.size());
  interaction_.setZero();
  for (size_t m = 0; m < members_.size(); ++m) {
    Member& member = members_[m];
    const HipModel& model = networks_.hips[m];
    Eigen::ArrayX2d places(people, 2);
    for (Eigen::Index i = 0; i < people; ++i) {
      places.row(i) =
          (influence_.place.row(i) + ToGround(influence_.headings.row(i), member.states.hip.row(i)))
              .cast<double>()
              .array();
    }
    const auto& pairs = member.neighbours.Find(places, model.config().reach_m);
    AddContact(pairs, member.states);
    FloorVectors effect;
    model.Step(influence_, pairs, member.states, &effect);
    for (Eigen::Index i = 0; i < people; ++i) {
      interaction_.row(i) += share * static_cast<float>(scene_.people[i].mass_kg) *
                             ToGround(influence_.headings.row(i), effect.row(i));
    }
  }
}

HipMoment HipEnsemble::Next() {
  HipMoment now = Look();
  const FloorVectors places = first_place_ + now.path;
  const double reach = networks_.hips.front().config().reach_m;
  watch_.Observe(next_, places, now.rate, neighbours_.Find(places.cast<double>().array(), reach));
  BeginPeople(now);
  influence_.activity = watch_.activity();
  for (const int i : watch_.beginners()) now.lean_change.row(i).setZero();
  now.headings = influence_.headings;
  now.beginners = watch_.beginners();
  for (size_t i = 0; i < scene_.people.size(); ++i) {
    now.takes_part.push_back(watch_.takes_part(static_cast<int>(i)));
  }
  ApplyPushes(next_);
  Step();
  ++next_;
  return now;
}

}  // namespace poise::push
