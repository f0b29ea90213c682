#include "core/prediction/mixer/mixer_predictor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/isa.h"

namespace poise::prediction {
namespace {

using motion::Clip;
using motion::Quat;
using motion::Vec3;

void Append(const auto& values, float*& out) {
  for (Eigen::Index i = 0; i < values.size(); ++i) *out++ = static_cast<float>(values[i]);
}

Vec3 VectorAt(const float* numbers) { return Vec3(numbers[0], numbers[1], numbers[2]); }

void RunKernel(const MixerArguments& arguments) {
  static const auto kernel =
      base::SelectKernel(isa_v2::MixerKernel, isa_v3::MixerKernel, isa_v4::MixerKernel);
  kernel(arguments);
}

}  // namespace

MixerPredictor::MixerPredictor(const MixerConfig& config, NetworkBody body)
    : body_(std::move(body)),
      signature_{.skeleton = body_.skeleton,
                 .frame_rate = body_.frame_rate,
                 .past_frames = config.past_frames,
                 .max_future_frames = config.future_frames} {
  arguments_.sizes = {.past = config.past_frames,
                      .future = config.future_frames,
                      .joints = static_cast<int>(body_.joints.size()),
                      .width = config.width,
                      .groups = config.groups,
                      .hidden = config.hidden,
                      .blocks = config.blocks};
}

StatusOr<std::shared_ptr<const MixerPredictor>> MixerPredictor::Create(
    const MixerConfig& config, NetworkBody body, const base::TensorFile& weights) {
  std::shared_ptr<MixerPredictor> predictor(new MixerPredictor(config, std::move(body)));
  POISE_RETURN_IF_ERROR(predictor->Load(weights));
  return predictor;
}

StatusOr<const float*> MixerPredictor::Take(const base::TensorFile& weights,
                                            const std::string& name, std::vector<int64_t> shape) {
  POISE_ASSIGN_OR_RETURN(std::vector<float> numbers, weights.Floats(name, shape));
  return (numbers_[name] = std::move(numbers)).data();
}

StatusOr<MixerLayer> MixerPredictor::TakeLayer(const base::TensorFile& weights,
                                               const std::string& name,
                                               std::vector<int64_t> shape) {
  MixerLayer layer;
  POISE_ASSIGN_OR_RETURN(layer.bias, Take(weights, name + ".bias", {shape.front()}));
  POISE_ASSIGN_OR_RETURN(layer.weight, Take(weights, name + ".weight", std::move(shape)));
  return layer;
}

Status MixerPredictor::Load(const base::TensorFile& weights) {
  const MixerSizes& s = arguments_.sizes;
  const int64_t tokens = s.joints + 1;
  POISE_ASSIGN_OR_RETURN(arguments_.past_dct, Take(weights, "past_dct", {s.past, s.past}));
  POISE_ASSIGN_OR_RETURN(arguments_.future_dct, Take(weights, "future_dct", {s.future, s.future}));
  POISE_ASSIGN_OR_RETURN(arguments_.joint_in,
                         TakeLayer(weights, "joint_in", {s.width, MixerJointInputs(s.past)}));
  POISE_ASSIGN_OR_RETURN(arguments_.root_in,
                         TakeLayer(weights, "root_in", {s.width, MixerRootInputs(s.past)}));
  POISE_ASSIGN_OR_RETURN(arguments_.names, Take(weights, "names", {tokens, s.width}));
  for (int i = 0; i < s.blocks; ++i) {
    const std::string name = fmt::format("block{}_", i);
    MixerBlock block;
    POISE_ASSIGN_OR_RETURN(block.joint_norm, TakeLayer(weights, name + "joint_norm", {s.width}));
    POISE_ASSIGN_OR_RETURN(block.joints,
                           Take(weights, name + "joints", {s.groups, tokens, tokens}));
    POISE_ASSIGN_OR_RETURN(block.within_norm, TakeLayer(weights, name + "within_norm", {s.width}));
    POISE_ASSIGN_OR_RETURN(block.up, TakeLayer(weights, name + "up", {s.hidden, s.width}));
    POISE_ASSIGN_OR_RETURN(block.down, TakeLayer(weights, name + "down", {s.width, s.hidden}));
    blocks_.push_back(block);
  }
  arguments_.blocks = blocks_.data();
  POISE_ASSIGN_OR_RETURN(arguments_.out_norm, TakeLayer(weights, "out_norm", {s.width}));
  POISE_ASSIGN_OR_RETURN(arguments_.joint_out,
                         TakeLayer(weights, "joint_out", {3 * s.future, s.width}));
  POISE_ASSIGN_OR_RETURN(arguments_.root_out,
                         TakeLayer(weights, "root_out", {6 * s.future, s.width}));
  POISE_ASSIGN_OR_RETURN(scale_,
                         weights.Floats("scale", std::vector<int64_t>{MixerFeatures(s.joints)}));
  return absl::OkStatus();
}

void MixerPredictor::WriteFeatures(const Clip& past, float* features, float* still) const {
  const int last = past.num_frames() - 1;
  const Quat root_from_world = past.rotation(last, 0).conjugate();
  float* out = features;
  for (int frame = past.num_frames() - signature_.past_frames; frame <= last; ++frame) {
    for (const int joint : body_.joints) {
      Append(math::ToRotationVector(past.rotation(last, joint).conjugate() *
                                    past.rotation(frame, joint)),
             out);
    }
    Append(math::ToRotationVector(root_from_world * past.rotation(frame, 0)), out);
    Append(root_from_world * Vec3(past.root_position(frame) - past.root_position(last)), out);
  }
  const size_t columns = scale_.size();
  for (float* value = features; value != out; ++value)
    *value /= scale_[(value - features) % columns];
  for (const int joint : body_.joints) Append(math::ToSixD(past.rotation(last, joint)), still);
  Append(root_from_world * Vec3::UnitY(), still);
}

StatusOr<Clip> MixerPredictor::Decode(const Clip& past, const float* features,
                                      int future_frames) const {
  const int last = past.num_frames() - 1;
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  rotations.reserve(static_cast<size_t>(future_frames) * past.num_joints());
  std::vector<float> change(scale_.size());
  for (int frame = 0; frame < future_frames; ++frame, features += scale_.size()) {
    std::transform(scale_.begin(), scale_.end(), features, change.begin(), std::multiplies<>());
    const size_t first = rotations.size();
    rotations.insert(rotations.end(), past.pose(last).begin(), past.pose(last).end());
    const float* turn = change.data();
    for (const int joint : body_.joints) {
      rotations[first + joint] *= math::FromRotationVector(VectorAt(turn));
      turn += 3;
    }
    rotations[first] *= math::FromRotationVector(VectorAt(turn));
    positions.push_back(past.root_position(last) + past.rotation(last, 0) * VectorAt(turn + 3));
  }
  StatusOr<Clip> future = Clip::Create(past.name(), past.skeleton(), past.frame_rate(),
                                       std::move(positions), std::move(rotations));
  if (future.ok()) return future;
  return base::Internal("NOT_FINITE",
                        fmt::format("clip '{}': the network's answer is no motion: {}", past.name(),
                                    base::Message(future.status())));
}

StatusOr<std::vector<Clip>> MixerPredictor::Predict(std::span<const Observation> batch,
                                                    int future_frames,
                                                    const base::RunContext& context) const {
  POISE_RETURN_IF_ERROR(CheckObservations(signature_, batch, future_frames));
  POISE_RETURN_IF_ERROR(context.Check());
  const MixerSizes& sizes = arguments_.sizes;
  const size_t features = scale_.size(), still_features = MixerStillFeatures(sizes.joints);
  std::vector<float> past(batch.size() * sizes.past * features);
  std::vector<float> still(batch.size() * still_features);
  std::vector<float> future(batch.size() * sizes.future * features);
  for (size_t i = 0; i < batch.size(); ++i) {
    WriteFeatures(batch[i].past, past.data() + i * sizes.past * features,
                  still.data() + i * still_features);
  }
  MixerArguments arguments = arguments_;
  arguments.batch = static_cast<int>(batch.size());
  arguments.past = past.data();
  arguments.still = still.data();
  arguments.future = future.data();
  RunKernel(arguments);
  std::vector<Clip> futures;
  for (size_t i = 0; i < batch.size(); ++i) {
    POISE_ASSIGN_OR_RETURN(
        Clip clip,
        Decode(batch[i].past, future.data() + i * sizes.future * features, future_frames));
    futures.push_back(std::move(clip));
  }
  return futures;
}

}  // namespace poise::prediction
