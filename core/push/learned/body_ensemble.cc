#include "core/push/learned/body_ensemble.h"

#include <algorithm>

#include "core/push/learned/push_context.h"
#include "core/push/restoration/planted_feet.h"
#include "core/push/restoration/rigid_fit.h"

namespace poise::push {
namespace {

BodyTurns NoTurns() {
  BodyTurns turns;
  turns.fill(math::Quat::Identity());
  return turns;
}

// A turn that is stated in a heading's frame, in the ground frame.
math::Quat InGround(const math::Quat& heading, const math::Quat& turn) {
  const Vec3 axis = heading * Vec3(turn.vec());
  return {turn.w(), axis.x(), axis.y(), axis.z()};
}

}  // namespace

BodyEnsemble::BodyEnsemble(const PushScene& scene, const PushNetworks& networks)
    : scene_(scene),
      networks_(networks),
      bodies_(MatrixXf::Zero(scene.people.size(), kBodySize)),
      turns_(scene.people.size(), NoTurns()),
      heights_(Eigen::VectorXf::Zero(scene.people.size())) {
  for (const ScenePerson& person : scene.people) {
    people_.push_back({.body = {},
                       .turns = {},
                       .heading = math::Quat::Identity(),
                       .steps = StepPlanner({person.shape[kRightToe], person.shape[kLeftToe]})});
  }
  for (const PoseModel& model : networks.poses) {
    memories_.push_back(MatrixXf::Zero(scene.people.size(), model.config().hidden));
  }
}

void BodyEnsemble::Begin(int i, const HipMoment& now) {
  Person& person = people_[i];
  person.turns = turns_[i];
  person.heading = TurnOf(now.headings.row(i));
  person.place = now.path.row(i);
  person.height = heights_[i];
  const BodyShape ground = Turned(scene_.people[i].shape, turns_[i]);
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    person.body[joint] = person.heading.conjugate() * ground[joint];
    if (joint == 0) continue;
    bodies_.row(i).segment<3>(3 * (joint - 1)) = person.body[joint].cast<float>().transpose();
  }
  bodies_(i, kBodySize - 1) = MassFeature(scene_.people[i].mass_kg);
  for (MatrixXf& memory : memories_) memory.row(i).setZero();
}

MatrixXf BodyEnsemble::Paths(const HipMoment& now, const HipMoment& middle,
                             const HipMoment& far) const {
  MatrixXf paths(bodies_.rows(), kPathSize);
  const bool lean = networks_.poses.front().config().lean_input;
  for (Eigen::Index i = 0; i < paths.rows(); ++i) {
    const Eigen::RowVector2f heading = now.headings.row(i);
    const auto own = [&](const Eigen::RowVector2f& ground) { return FromGround(heading, ground); };
    Eigen::RowVector2f leaning = Eigen::RowVector2f::Zero();
    if (lean) leaning = float{kLeanScale} * now.lean_change.row(i);
    paths.row(i) << own(now.path.row(i) - people_[i].place), own(now.rate.row(i)),
        own(middle.path.row(i) - now.path.row(i)), own(middle.rate.row(i)),
        own(far.path.row(i) - now.path.row(i)), own(far.rate.row(i)), leaning;
  }
  return paths;
}

void BodyEnsemble::Turn(int i, const Eigen::RowVectorXf& change) {
  const Person& person = people_[i];
  BodyShape wanted = person.body;
  for (int joint = 1; joint < kBodyJoints; ++joint) {
    wanted[joint] += change.segment<3>(3 * (joint - 1)).cast<double>().transpose();
  }
  const BodyTurns turns = FitTurns(person.body, wanted);
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    turns_[i][joint] = (InGround(person.heading, turns[joint]) * person.turns[joint]).normalized();
  }
  heights_[i] = person.height + change[kHeightColumn];
}

// Legs bend so that a foot that stands stays where it is and one that swings goes where it lands.
void BodyEnsemble::PlaceFeet(int i, const HipMoment& now, const Eigen::RowVectorXf& change,
                             bool step) {
  if (!networks_.steps.enabled) return;
  Person& person = people_[i];
  const ScenePerson& first = scene_.people[i];
  std::array<FootWish, 2> wishes;
  for (int foot = 0; foot < 2; ++foot) {
    const Eigen::RowVector2f from_pelvis =
        person.body[kToes[foot]].head<2>().cast<float>().transpose() +
        change.segment<2>(kFootholdColumn + 2 * foot);
    const Eigen::RowVector2f place = now.path.row(i) + ToGround(now.headings.row(i), from_pelvis);
    wishes[foot] = {
        change[kSwingColumn + foot], place.cast<double>().transpose(),
        now.path.row(i).cast<double>().transpose() + first.shape[kToes[foot]].head<2>()};
  }
  const Vec3 pelvis(now.path(i, 0), now.path(i, 1), heights_[i]);
  if (step) person.steps.Step(networks_.steps, wishes, now.takes_part[i]);
  std::array<Vec3, 2> toes = person.steps.toes();
  for (Vec3& toe : toes) toe -= pelvis;
  PlantFeet(first.shape, toes, turns_[i]);
}

void BodyEnsemble::Step(const HipMoment& now, const HipMoment& middle, const HipMoment& far) {
  for (const int person : now.beginners) Begin(person, now);
  std::vector<bool> moves = now.takes_part;
  for (size_t i = 0; i < moves.size(); ++i) moves[i] = moves[i] || people_[i].steps.swinging();
  if (std::none_of(moves.begin(), moves.end(), [](bool one) { return one; })) return;
  const MatrixXf paths = Paths(now, middle, far);
  MatrixXf change = MatrixXf::Zero(bodies_.rows(), kPoseSize);
  for (size_t m = 0; m < memories_.size(); ++m) {
    change += networks_.poses[m].Step(paths, bodies_, memories_[m]);
  }
  change /= static_cast<float>(memories_.size());
  std::vector<bool> fresh(people_.size(), false);
  for (const int person : now.beginners) fresh[person] = true;
  for (size_t i = 0; i < people_.size(); ++i) {
    // In the frame in which somebody begins the pose is known.
    if (!moves[i]) continue;
    if (!fresh[i]) Turn(static_cast<int>(i), change.row(i));
    const bool stands = fresh[i] && now.path.row(i).isZero();
    if (!stands) PlaceFeet(static_cast<int>(i), now, change.row(i), !fresh[i]);
  }
}

}  // namespace poise::push
