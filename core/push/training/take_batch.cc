#include "core/push/training/take_batch.h"

#include <algorithm>

#include "core/push/learned/push_context.h"

namespace poise::push {
namespace {

TakeBatch EmptyBatch(std::span<const PushTake* const> takes) {
  int64_t people = 0, frames = 0;
  for (const PushTake* take : takes) {
    people = std::max<int64_t>(people, take->people.size());
    frames = std::max<int64_t>(frames, take->frames);
  }
  const auto count = static_cast<int64_t>(takes.size());
  return {.hip = torch::zeros({count, people, frames, 2}),
          .lean = torch::zeros({count, people, frames, 2}),
          .place = torch::zeros({count, people, 2}),
          .push = torch::zeros({count, people, frames, 2}),
          .context = torch::zeros({count, people, kContextSize}),
          .mask = torch::zeros({count, people, frames})};
}

PendulumPose PoseOf(const TakePerson& person, int frame) {
  return PendulumOf(person.joint(frame, kPelvis), person.joint(frame, kRightAnkle),
                    person.joint(frame, kLeftAnkle));
}

// How one take differs from its recording.
struct Variant {
  double side = 1;     // -1: mirrored
  bool still = false;  // nobody is pushed, nobody moves
};

void FillPerson(const PushTake& take, int64_t row, size_t i, const PushInput& input,
                const Variant& variant, TakeBatch& batch) {
  const double side = variant.side;
  const TakePerson& person = take.people[i];
  const PendulumPose first = PoseOf(person, 0);
  const Vec3 start = person.joint(0, kPelvis);
  const Vec3 place = start - take.people[0].joint(0, kPelvis);
  auto hip = batch.hip.accessor<float, 4>(), lean = batch.lean.accessor<float, 4>();
  auto push = batch.push.accessor<float, 4>();
  auto mask = batch.mask.accessor<float, 3>(), places = batch.place.accessor<float, 3>();
  for (int frame = 0; frame < take.frames; ++frame) {
    mask[row][i][frame] = 1;
    if (variant.still) continue;
    const Vec3 path = person.joint(frame, kPelvis) - start;
    const Eigen::Vector4d moved = PoseOf(person, frame).position - first.position;
    for (int axis = 0; axis < 2; ++axis) {
      const double sign = axis == 0 ? 1 : side;
      hip[row][i][frame][axis] = static_cast<float>(sign * path[axis]);
      lean[row][i][frame][axis] = static_cast<float>(sign * moved[2 + axis]);
    }
  }
  places[row][i][0] = static_cast<float>(place.x());
  places[row][i][1] = static_cast<float>(side * place.y());
  PersonFacts facts{.alone = take.people.size() == 1,
                    .mass_kg = person.mass_kg,
                    .theta = first.position[2],
                    .phi = side * first.position[3]};
  if (i == 0 && !variant.still) {
    facts.pushed = true;
    facts.impulse_ns = input.impulse_ns;
    facts.push_frames = take.push_frames;
    for (size_t frame = 0; frame < input.force_n.size(); ++frame) {
      const Eigen::Vector2d scaled = input.force_n[frame] * kPushScale / person.mass_kg;
      push[row][i][frame][0] = static_cast<float>(scaled.x());
      push[row][i][frame][1] = static_cast<float>(side * scaled.y());
    }
  }
  const auto context = ContextOf(facts);
  std::copy(context.begin(), context.end(),
            batch.context.data_ptr<float>() + (row * batch.people() + i) * kContextSize);
}

}  // namespace

TakeBatch MakeBatch(std::span<const PushTake* const> takes, Protocol protocol,
                    const TakeVariation& variation, base::Random& random) {
  TakeBatch batch = EmptyBatch(takes);
  for (size_t row = 0; row < takes.size(); ++row) {
    const PushTake& take = *takes[row];
    const PushInput input = InputOf(take, protocol, random);
    Variant variant;
    if (variation.mirror && random.Uniform() < 0.5) variant.side = -1;
    if (variation.still_share > 0) variant.still = random.Uniform() < variation.still_share;
    for (size_t i = 0; i < take.people.size(); ++i) FillPerson(take, row, i, input, variant, batch);
  }
  return batch;
}

TakeBatch Extended(TakeBatch batch, int64_t frames) {
  const int64_t more = frames - batch.frames();
  if (more <= 0) return batch;
  for (torch::Tensor* tensor : {&batch.hip, &batch.lean, &batch.push}) {
    *tensor = torch::constant_pad_nd(*tensor, {0, 0, 0, more});
  }
  batch.mask = torch::constant_pad_nd(batch.mask, {0, more});
  return batch;
}

}  // namespace poise::push
