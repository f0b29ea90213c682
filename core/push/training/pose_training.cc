#include "core/push/training/pose_training.h"

#include <algorithm>
#include <array>

#include "core/learning/nn/guard.h"
#include "core/push/body_joints.h"
#include "core/push/learned/push_context.h"
#include "core/push/pendulum/pendulum.h"

namespace poise::push {
namespace {

using torch::Tensor;

// Joints after a reflection that swaps left and right.
constexpr std::array<int, kBodyJoints> kMirrored = {0, 1, 2, 3,  4,  5,  10, 11, 12, 13, 6,
                                                    7, 8, 9, 18, 19, 20, 21, 14, 15, 16, 17};

struct Distortion {
  double side = 1;
  double scale = 1;
};

void FillPerson(const PersonRef& ref, int64_t row, const Distortion& distortion, PoseBatch& batch) {
  constexpr double kSlowing = 0.9;  // of the last speed, a frame
  const TakePerson& person = ref.take->people[ref.person];
  const int frames = ref.take->frames;
  auto hip = batch.hip.accessor<float, 3>(), lean = batch.lean.accessor<float, 3>();
  auto joints = batch.joints.accessor<float, 4>();
  auto height = batch.height.accessor<float, 2>(), mask = batch.mask.accessor<float, 2>();
  auto body = batch.body.accessor<float, 2>();
  const auto pose = [&](int frame) {
    return PendulumOf(person.joint(frame, kPelvis), person.joint(frame, kRightAnkle),
                      person.joint(frame, kLeftAnkle));
  };
  const Vec3 start = person.joint(0, kPelvis);
  const Eigen::Vector3d flip(1, distortion.side, 1);
  const auto set_hip = [&](int64_t frame, const Eigen::Vector2d& place) {
    hip[row][frame][0] = static_cast<float>(distortion.scale * place.x());
    hip[row][frame][1] = static_cast<float>(distortion.scale * distortion.side * place.y());
  };
  Eigen::Vector2d place = Eigen::Vector2d::Zero(), speed = Eigen::Vector2d::Zero();
  for (int64_t frame = 0; frame < hip.size(1); ++frame) {
    if (frame < frames) {
      const Eigen::Vector2d next = (person.joint(frame, kPelvis) - start).head<2>();
      speed = next - place;
      place = next;
    } else {
      speed *= kSlowing;
      place += speed;
    }
    set_hip(frame, place);
  }
  for (int frame = 0; frame < frames; ++frame) {
    const Vec3 pelvis = person.joint(frame, kPelvis);
    const Eigen::Vector4d moved = pose(frame).position - pose(0).position;
    lean[row][frame][0] = static_cast<float>(moved[2]);
    lean[row][frame][1] = static_cast<float>(distortion.side * moved[3]);
    height[row][frame] = static_cast<float>(pelvis.z() - start.z());
    mask[row][frame] = 1;
    for (int joint = 0; joint < kBodyJoints; ++joint) {
      const int source = distortion.side < 0 ? kMirrored[joint] : joint;
      const Vec3 from_pelvis = flip.cwiseProduct(person.joint(frame, source) - pelvis);
      for (int axis = 0; axis < 3; ++axis) {
        joints[row][frame][joint][axis] = static_cast<float>(from_pelvis[axis]);
        if (frame == 0 && joint > 0) {
          body[row][3 * (joint - 1) + axis] = static_cast<float>(from_pelvis[axis]);
        }
      }
    }
  }
  body[row][63] = MassFeature(person.mass_kg);
}

Tensor PerPerson(const Tensor& values, const Tensor& mask) {
  return ((values * mask).sum(1) / mask.sum(1).clamp_min(1)).mean();
}

Tensor JointError(const Tensor& a, const Tensor& b) {
  return ((a - b).square().sum(-1) + 1e-8).sqrt().mean(-1);
}

learning::Loss LossOf(const PosePaths& found, const PoseBatch& batch, const PoseTraining& config) {
  const auto rate = [](const Tensor& path) {
    return (path.slice(1, 1) - path.slice(1, 0, -1)) * kFrameRate;
  };
  const Tensor place = PerPerson(JointError(found.joints, batch.joints), batch.mask);
  const Tensor height = PerPerson((found.height - batch.height).abs(), batch.mask);
  const Tensor speed =
      PerPerson(JointError(rate(found.joints), rate(batch.joints)), batch.mask.slice(1, 1));
  return {.total = place + 0.5 * height + config.speed_weight * speed,
          .terms = {{"pose_m", place.item<double>()},
                    {"height_m", height.item<double>()},
                    {"speed_mps", speed.item<double>()}}};
}

}  // namespace

std::vector<PersonRef> PeopleOf(const std::vector<const PushTake*>& takes) {
  std::vector<PersonRef> people;
  for (const PushTake* take : takes) {
    for (int i = 0; i < static_cast<int>(take->people.size()); ++i) people.push_back({take, i});
  }
  return people;
}

PoseBatch MakePoseBatch(const std::vector<PersonRef>& people, int lookahead,
                        const PoseTraining& config, base::Random* random) {
  int64_t frames = 0;
  for (const PersonRef& ref : people) frames = std::max<int64_t>(frames, ref.take->frames);
  const auto count = static_cast<int64_t>(people.size());
  PoseBatch batch{.hip = torch::zeros({count, frames + lookahead, 2}),
                  .lean = torch::zeros({count, frames, 2}),
                  .body = torch::zeros({count, kBodySize}),
                  .joints = torch::zeros({count, frames, kBodyJoints, 3}),
                  .height = torch::zeros({count, frames}),
                  .mask = torch::zeros({count, frames})};
  for (int64_t row = 0; row < count; ++row) {
    Distortion distortion;
    if (random != nullptr) {
      if (config.mirror && random->Uniform() < 0.5) distortion.side = -1;
      distortion.scale = 1 + config.hip_distortion * random->Normal();
    }
    FillPerson(people[row], row, distortion, batch);
  }
  return batch;
}

StatusOr<TrainedPose> TrainPose(const TrainingTakes& takes, const PoseConfig& net,
                                const PoseTraining& config, const base::RunContext& context,
                                const Resumption& resumption) {
  return learning::Guard("train the pose network", [&]() -> StatusOr<TrainedPose> {
    learning::SeedTorch(context.seed);
    TrainedPose trained{PoseNet(net), {}, {}};
    const std::vector<PersonRef> people = PeopleOf(takes.train);
    const PoseBatch validation =
        MakePoseBatch(PeopleOf(takes.validation), net.lookahead, config, nullptr);
    const auto loss = [&](const learning::Batch& step) -> StatusOr<learning::Loss> {
      std::vector<PersonRef> chosen;
      for (const int64_t sample : step.samples) chosen.push_back(people[sample]);
      const PoseBatch batch = MakePoseBatch(chosen, net.lookahead, config, &step.random);
      return LossOf(trained.net->Forward(batch), batch, config);
    };
    NetworkTask task{
        .name = "pose",
        .module = trained.net.ptr(),
        .config = config.network,
        .num_samples = static_cast<int64_t>(people.size()),
        .loss = loss,
        .validate = [&]() -> StatusOr<double> {
          return LossOf(trained.net->Forward(validation), validation, config).terms.at("pose_m");
        }};
    POISE_ASSIGN_OR_RETURN(trained.report,
                           TrainNetwork(std::move(task), context, resumption, &trained.curve_csv));
    return trained;
  });
}

}  // namespace poise::push
