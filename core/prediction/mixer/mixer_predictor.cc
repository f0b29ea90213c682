#include "core/prediction/mixer/mixer_predictor.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

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

}  // namespace

MixerPredictor::MixerPredictor(const MixerConfig& config, NetworkBody body)
    : NetworkPredictor(std::move(body), config.past_frames, config.future_frames) {
  arguments_.sizes = {.past = config.past_frames,
                      .future = config.future_frames,
                      .joints = static_cast<int>(this->body().joints.size()),
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

Status MixerPredictor::Load(const base::TensorFile& weights) {
  const MixerSizes& s = arguments_.sizes;
  const int64_t tokens = s.joints + 1;
  const auto take = [&](const std::string& name, std::vector<int64_t> shape) {
    return numbers_.Take(weights, name, std::move(shape));
  };
  const auto linear = [&](const std::string& name, int64_t outputs, int64_t inputs) {
    return numbers_.TakeLinear(weights, name, outputs, inputs);
  };
  const auto norm = [&](const std::string& name) {
    return numbers_.TakeNorm(weights, name, s.width);
  };
  POISE_ASSIGN_OR_RETURN(arguments_.past_dct, take("past_dct", {s.past, s.past}));
  POISE_ASSIGN_OR_RETURN(arguments_.future_dct, take("future_dct", {s.future, s.future}));
  POISE_ASSIGN_OR_RETURN(arguments_.joint_in,
                         linear("joint_in", s.width, MixerJointInputs(s.past)));
  POISE_ASSIGN_OR_RETURN(arguments_.root_in, linear("root_in", s.width, MixerRootInputs(s.past)));
  POISE_ASSIGN_OR_RETURN(arguments_.names, take("names", {tokens, s.width}));
  for (int i = 0; i < s.blocks; ++i) {
    const std::string name = fmt::format("block{}_", i);
    MixerBlock block;
    POISE_ASSIGN_OR_RETURN(block.joint_norm, norm(name + "joint_norm"));
    POISE_ASSIGN_OR_RETURN(block.joints, take(name + "joints", {s.groups, tokens, tokens}));
    POISE_ASSIGN_OR_RETURN(block.within_norm, norm(name + "within_norm"));
    POISE_ASSIGN_OR_RETURN(block.up, linear(name + "up", s.hidden, s.width));
    POISE_ASSIGN_OR_RETURN(block.down, linear(name + "down", s.width, s.hidden));
    blocks_.push_back(block);
  }
  arguments_.blocks = blocks_.data();
  POISE_ASSIGN_OR_RETURN(arguments_.out_norm, norm("out_norm"));
  POISE_ASSIGN_OR_RETURN(arguments_.joint_out, linear("joint_out", 3 * s.future, s.width));
  POISE_ASSIGN_OR_RETURN(arguments_.root_out, linear("root_out", 6 * s.future, s.width));
  POISE_ASSIGN_OR_RETURN(scale_,
                         weights.Floats("scale", std::vector<int64_t>{MixerFeatures(s.joints)}));
  return absl::OkStatus();
}

NetworkPredictor::Sizes MixerPredictor::sizes() const {
  const MixerSizes& s = arguments_.sizes;
  const size_t features = MixerFeatures(s.joints);
  return {s.past * features + MixerStillFeatures(s.joints), s.future * features};
}

void MixerPredictor::Encode(const Clip& past, float* inputs) const {
  const int last = past.num_frames() - 1;
  const Quat root_from_world = past.rotation(last, 0).conjugate();
  float* out = inputs;
  for (int frame = past.num_frames() - arguments_.sizes.past; frame <= last; ++frame) {
    for (const int joint : body().joints) {
      Append(math::ToRotationVector(past.rotation(last, joint).conjugate() *
                                    past.rotation(frame, joint)),
             out);
    }
    Append(math::ToRotationVector(root_from_world * past.rotation(frame, 0)), out);
    Append(root_from_world * Vec3(past.root_position(frame) - past.root_position(last)), out);
  }
  const size_t columns = scale_.size();
  for (float* value = inputs; value != out; ++value) *value /= scale_[(value - inputs) % columns];
  for (const int joint : body().joints) Append(math::ToSixD(past.rotation(last, joint)), out);
  Append(root_from_world * Vec3::UnitY(), out);
}

void MixerPredictor::Forward(int batch, const float* inputs, float* outputs) const {
  static const auto kernel =
      base::SelectKernel(isa_v2::MixerKernel, isa_v3::MixerKernel, isa_v4::MixerKernel);
  MixerArguments arguments = arguments_;
  arguments.batch = batch;
  arguments.inputs = inputs;
  arguments.outputs = outputs;
  kernel(arguments);
}

void MixerPredictor::Decode(const Clip& past, const float* outputs, FuturePoses& future) const {
  const int last = past.num_frames() - 1;
  std::vector<float> change(scale_.size());
  for (int frame = 0; frame < future.num_frames(); ++frame, outputs += scale_.size()) {
    std::transform(scale_.begin(), scale_.end(), outputs, change.begin(), std::multiplies<>());
    const float* turn = change.data();
    for (const int joint : body().joints) {
      future.rotation(frame, joint) *= math::FromRotationVector(VectorAt(turn));
      turn += 3;
    }
    future.rotation(frame, 0) *= math::FromRotationVector(VectorAt(turn));
    future.root_positions[frame] += past.rotation(last, 0) * VectorAt(turn + 3);
  }
}

}  // namespace poise::prediction
