#include "core/push/ldp/take_tensors.h"

#include <algorithm>

namespace poise::push::ldp {
namespace {

using torch::Tensor;

void Fill(const PushTake& take, int64_t row, const PushInput& input, TakeTensors& tensors) {
  const Vec3 origin = take.people[0].joint(0, kPelvis);
  auto position = tensors.recorded.position.accessor<float, 4>();
  auto rod = tensors.recorded.rod.accessor<float, 3>(), mask = tensors.mask.accessor<float, 3>();
  auto hip = tensors.hip.accessor<float, 4>();
  auto mass = tensors.mass.accessor<float, 2>(), height = tensors.cart_height.accessor<float, 2>();
  for (size_t i = 0; i < take.people.size(); ++i) {
    const TakePerson& person = take.people[i];
    mass[row][i] = static_cast<float>(person.mass_kg);
    height[row][i] = static_cast<float>(RecordedPendulum(person, 0).cart_height);
    // Behind the end the last frame stays, so that nothing there is out of range.
    for (int64_t frame = 0; frame < tensors.frames(); ++frame) {
      const int recorded = static_cast<int>(std::min<int64_t>(frame, take.frames - 1));
      const PendulumPose pose = RecordedPendulum(person, recorded);
      const Vec3 place = person.joint(recorded, kPelvis) - Vec3(origin.x(), origin.y(), 0);
      for (int axis = 0; axis < 4; ++axis) {
        const double shift = axis < 2 ? origin[axis] : 0;
        position[row][i][frame][axis] = static_cast<float>(pose.position[axis] - shift);
      }
      for (int axis = 0; axis < 3; ++axis) {
        hip[row][i][frame][axis] = static_cast<float>(place[axis]);
      }
      rod[row][i][frame] = static_cast<float>(pose.rod);
      mask[row][i][frame] = frame < take.frames ? 1 : 0;
    }
  }
  auto push = tensors.push.accessor<float, 3>(), hip_push = tensors.hip_push.accessor<float, 3>();
  for (size_t frame = 0; frame < input.force_n.size(); ++frame) {
    for (int axis = 0; axis < 4; ++axis) {
      push[row][frame][axis] =
          input.generalised.empty() ? 0 : static_cast<float>(input.generalised[frame][axis]);
    }
    for (int axis = 0; axis < 2; ++axis) {
      hip_push[row][frame][axis] =
          input.generalised.empty() ? static_cast<float>(input.force_n[frame][axis]) : 0;
    }
  }
  tensors.push_frames[row] = take.push_frames;
}

}  // namespace

PendulumPose RecordedPendulum(const TakePerson& person, int frame) {
  return PaperPendulumOf(person.joint(frame, kPelvis), person.joint(frame, kRightAnkle),
                         person.joint(frame, kLeftAnkle));
}

TakeTensors TakeTensors::To(torch::ScalarType type) const {
  const auto to = [&](const Tensor& tensor) { return tensor.to(type); };
  return {{to(recorded.position), to(recorded.velocity), to(recorded.rod)},
          to(hip),
          to(mass),
          to(cart_height),
          to(push),
          to(hip_push),
          push_frames,
          to(mask)};
}

TakeTensors MakeTakeTensors(std::span<const PushTake* const> takes, Protocol protocol,
                            base::Random& random) {
  // People who are not there get a body, so that their equations can be solved.
  constexpr double kNobodysMass = 80;
  int64_t people = 0, frames = 0;
  for (const PushTake* take : takes) {
    people = std::max<int64_t>(people, take->people.size());
    frames = std::max<int64_t>(frames, take->frames);
  }
  const auto count = static_cast<int64_t>(takes.size());
  TakeTensors tensors{.recorded = {torch::zeros({count, people, frames, 4}),
                                   {},
                                   torch::ones({count, people, frames})},
                      .hip = torch::zeros({count, people, frames, 3}),
                      .mass = torch::full({count, people}, kNobodysMass),
                      .cart_height = torch::zeros({count, people}),
                      .push = torch::zeros({count, frames, 4}),
                      .hip_push = torch::zeros({count, frames, 2}),
                      .push_frames = torch::zeros({count}, torch::kInt64),
                      .mask = torch::zeros({count, people, frames})};
  for (int64_t row = 0; row < count; ++row) {
    Fill(*takes[row], row, InputOf(*takes[row], protocol, random), tensors);
  }
  const Tensor& position = tensors.recorded.position;
  const Tensor change = (position.slice(2, 1) - position.slice(2, 0, -1)) * kFrameRate;
  tensors.recorded.velocity = torch::cat({torch::zeros_like(position.slice(2, 0, 1)), change}, 2);
  return tensors;
}

}  // namespace poise::push::ldp
