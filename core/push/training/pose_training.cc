#include "core/push/training/pose_training.h"

#include <algorithm>
#include <array>

#include "core/learning/nn/guard.h"
#include "core/motion/metrics/footsteps.h"
#include "core/push/body_joints.h"
#include "core/push/learned/push_context.h"
#include "core/push/pendulum/pendulum.h"
#include "core/push/takes/recorded_hip.h"

namespace poise::push {
namespace {

using torch::Tensor;

// Joints after a reflection that swaps left and right.
constexpr std::array<int, kBodyJoints> kMirrored = {0, 1, 2, 3,  4,  5,  10, 11, 12, 13, 6,
                                                    7, 8, 9, 18, 19, 20, 21, 14, 15, 16, 17};

struct Variant {
  double side = 1;  // -1: mirrored
  double scale = 1;
  const HipPaths* forecast = nullptr;  // of the take; null: hips as recorded
};

// Which foot swings when and where it stands before and after.
void FillFeet(const TakePerson& person, int64_t row, double side, PoseBatch& batch) {
  constexpr int kCutOff = 3;  // [frames] before the end: who knows where this foot comes down
  auto swings = batch.swings.accessor<float, 3>();
  auto footholds = batch.footholds.accessor<float, 4>();
  auto known = batch.foothold_known.accessor<float, 3>();
  const auto fill = [&](int foot, int frame, int landing) {
    const int column = side < 0 ? 1 - foot : foot;
    const Vec3 from_pelvis = person.joint(landing, kToes[foot]) - person.joint(frame, kPelvis);
    footholds[row][frame][column][0] = static_cast<float>(from_pelvis.x());
    footholds[row][frame][column][1] = static_cast<float>(side * from_pelvis.y());
    known[row][frame][column] = landing < person.frames() - kCutOff || landing == frame ? 1 : 0;
    swings[row][frame][column] = landing == frame ? 0 : 1;
  };
  for (int frame = 0; frame < person.frames(); ++frame) {
    for (int foot = 0; foot < 2; ++foot) fill(foot, frame, frame);
  }
  const auto steps = motion::FindFootsteps({kBodyJoints, person.joints}, {kToes, 2}, kFrameRate);
  for (const motion::Footstep& step : steps) {
    for (int frame = step.first; frame < step.last; ++frame) fill(step.foot, frame, step.last);
  }
}

void FillPerson(const PersonRef& ref, int64_t row, const Variant& variant, PoseBatch& batch) {
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
  const Eigen::Vector3d flip(1, variant.side, 1);
  const double signs[] = {variant.scale, variant.scale * variant.side};
  const int64_t hip_frames = frames + batch.hip.size(1) - batch.frames();
  std::vector<Eigen::Vector2d> path = RecordedHip(person, batch.hip.size(1));
  if (variant.forecast != nullptr) {
    const auto forecast = variant.forecast->hip.accessor<float, 3>();
    for (int64_t frame = 0; frame < hip_frames; ++frame) {
      path[frame] = {forecast[ref.person][frame][0], forecast[ref.person][frame][1]};
    }
  }
  for (int64_t frame = 0; frame < batch.hip.size(1); ++frame) {
    for (int axis = 0; axis < 2; ++axis) {
      hip[row][frame][axis] = static_cast<float>(signs[axis] * path[frame][axis]);
    }
  }
  FillFeet(person, row, variant.side, batch);
  for (int frame = 0; frame < frames; ++frame) {
    const Vec3 pelvis = person.joint(frame, kPelvis);
    Eigen::Vector2d moved = (pose(frame).position - pose(0).position).tail<2>();
    if (variant.forecast != nullptr) {
      const auto forecast = variant.forecast->lean.accessor<float, 3>();
      moved = {forecast[ref.person][frame][0], forecast[ref.person][frame][1]};
    }
    lean[row][frame][0] = static_cast<float>(moved[0]);
    lean[row][frame][1] = static_cast<float>(variant.side * moved[1]);
    height[row][frame] = static_cast<float>(pelvis.z() - start.z());
    mask[row][frame] = 1;
    for (int joint = 0; joint < kBodyJoints; ++joint) {
      const int source = variant.side < 0 ? kMirrored[joint] : joint;
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

Tensor Distance(const Tensor& a, const Tensor& b) {
  return ((a - b).square().sum(-1) + 1e-8).sqrt();
}

Tensor JointError(const Tensor& a, const Tensor& b) { return Distance(a, b).mean(-1); }

learning::Loss LossOf(const PosePaths& found, const PoseBatch& batch, const PoseTraining& config) {
  const auto rate = [](const Tensor& path) {
    return (path.slice(1, 1) - path.slice(1, 0, -1)) * kFrameRate;
  };
  const Tensor place = PerPerson(JointError(found.joints, batch.joints), batch.mask);
  const Tensor height = PerPerson((found.height - batch.height).abs(), batch.mask);
  const Tensor speed =
      PerPerson(JointError(rate(found.joints), rate(batch.joints)), batch.mask.slice(1, 1));
  const Tensor swing = PerPerson(torch::binary_cross_entropy_with_logits(
                                     found.swings, batch.swings, {}, {}, at::Reduction::None)
                                     .mean(-1),
                                 batch.mask);
  const Tensor foothold = PerPerson(
      (Distance(found.footholds, batch.footholds) * batch.foothold_known).mean(-1), batch.mask);
  return {.total = place + 0.5 * height + config.speed_weight * speed +
                   config.foot_weight * foothold + config.swing_weight * swing,
          .terms = {{"pose_m", place.item<double>()},
                    {"height_m", height.item<double>()},
                    {"speed_mps", speed.item<double>()},
                    {"swing", swing.item<double>()},
                    {"foothold_m", foothold.item<double>()}}};
}

// People who are alone, then people among others.
using Sets = std::array<std::vector<PersonRef>, 2>;

Sets SetsOf(const std::vector<const PushTake*>& takes) {
  Sets sets;
  for (const PersonRef& person : PeopleOf(takes)) {
    sets[person.take->people.size() > 1 ? 1 : 0].push_back(person);
  }
  return sets;
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
                        const PoseTraining& config, const HipForecasts& forecasts,
                        base::Random* random) {
  int64_t frames = 0;
  for (const PersonRef& ref : people) frames = std::max<int64_t>(frames, ref.take->frames);
  const auto count = static_cast<int64_t>(people.size());
  PoseBatch batch{.hip = torch::zeros({count, frames + lookahead, 2}),
                  .lean = torch::zeros({count, frames, 2}),
                  .body = torch::zeros({count, kBodySize}),
                  .joints = torch::zeros({count, frames, kBodyJoints, 3}),
                  .height = torch::zeros({count, frames}),
                  .swings = torch::zeros({count, frames, 2}),
                  .footholds = torch::zeros({count, frames, 2, 2}),
                  .foothold_known = torch::zeros({count, frames, 2}),
                  .mask = torch::zeros({count, frames})};
  for (int64_t row = 0; row < count; ++row) {
    Variant variant;
    const auto forecast = forecasts.find(people[row].take);
    if (forecast != forecasts.end()) variant.forecast = &forecast->second;
    if (random != nullptr) {
      if (config.mirror && random->Uniform() < 0.5) variant.side = -1;
      variant.scale = 1 + config.hip_distortion * random->Normal();
      if (random->Uniform() >= config.forecast_share) variant.forecast = nullptr;
    }
    FillPerson(people[row], row, variant, batch);
  }
  return batch;
}

StatusOr<TrainedPose> TrainPose(const TrainingTakes& takes, const HipForecasts& forecasts,
                                const PoseConfig& net, const PoseTraining& config,
                                const base::RunContext& context, const Resumption& resumption) {
  return learning::Guard("train the pose network", [&]() -> StatusOr<TrainedPose> {
    learning::SeedTorch(context.seed);
    TrainedPose trained{PoseNet(net), {}, {}};
    const Sets people = SetsOf(takes.train);
    std::vector<PoseBatch> validation;
    for (const std::vector<PersonRef>& set : SetsOf(takes.validation)) {
      if (set.empty()) continue;
      validation.push_back(MakePoseBatch(set, net.lookahead, config, forecasts, nullptr));
    }
    const auto loss = [&](const learning::Batch& step) -> StatusOr<learning::Loss> {
      std::vector<PersonRef> chosen;
      for (size_t i = 0; i < step.samples.size(); ++i) {
        const int drawn = step.random.Uniform() < config.single_share ? 0 : 1;
        const std::vector<PersonRef>& set = people[people[drawn].empty() ? 1 - drawn : drawn];
        chosen.push_back(set[step.random.Index(set.size())]);
      }
      const PoseBatch batch = MakePoseBatch(chosen, net.lookahead, config, forecasts, &step.random);
      return LossOf(trained.net->Forward(batch), batch, config);
    };
    const auto validate = [&]() -> StatusOr<double> {
      double error = 0;
      for (const PoseBatch& batch : validation) {
        error += LossOf(trained.net->Forward(batch), batch, config).terms.at("pose_m") /
                 static_cast<double>(validation.size());
      }
      return error;
    };
    NetworkTask task{.name = "pose",
                     .module = trained.net.ptr(),
                     .config = config.network,
                     .num_samples = static_cast<int64_t>(people[0].size() + people[1].size()),
                     .loss = loss,
                     .validate = validate};
    POISE_ASSIGN_OR_RETURN(trained.report,
                           TrainNetwork(std::move(task), context, resumption, &trained.curve_csv));
    return trained;
  });
}

}  // namespace poise::push
