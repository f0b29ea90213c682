#include "core/prediction/gcn/gcn_predictor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/isa.h"

namespace poise::prediction {
namespace {

using motion::Clip;
using motion::Quat;
using motion::Vec3;

constexpr float kNormEpsilon = 1e-5f;  // as LibTorch's BatchNorm1d

void RunKernel(const GcnArguments& arguments) {
  static const auto kernel =
      base::SelectKernel(isa_v2::GcnKernel, isa_v3::GcnKernel, isa_v4::GcnKernel);
  kernel(arguments);
}

}  // namespace

GcnPredictor::GcnPredictor(const GcnConfig& config, NetworkBody body)
    : config_(config),
      body_(std::move(body)),
      signature_{.skeleton = body_.skeleton,
                 .frame_rate = body_.frame_rate,
                 .past_frames = config.past_frames,
                 .max_future_frames = config.future_frames} {}

StatusOr<std::shared_ptr<const GcnPredictor>> GcnPredictor::Create(
    const GcnConfig& config, NetworkBody body, const base::TensorFile& weights) {
  std::shared_ptr<GcnPredictor> predictor(new GcnPredictor(config, std::move(body)));
  POISE_RETURN_IF_ERROR(predictor->Load(weights));
  return predictor;
}

const float* GcnPredictor::Keep(std::vector<float> numbers) {
  return numbers_.emplace_back(std::move(numbers)).data();
}

Status GcnPredictor::Load(const base::TensorFile& weights) {
  const int64_t frames = config_.frames();
  POISE_ASSIGN_OR_RETURN(const std::vector<float> sense,
                         weights.Floats("sense", std::vector<int64_t>{1}));
  sense_ = sense[0];
  POISE_ASSIGN_OR_RETURN(
      const std::vector<float> counts,
      weights.Floats("counts",
                     std::vector<int64_t>{static_cast<int64_t>(3 * body_.joints.size())}));
  for (size_t column = 0; column < counts.size(); ++column) {
    if (counts[column] > 0) columns_.push_back(static_cast<int>(column));
  }
  if (columns_.empty()) {
    return base::InvalidArgument("MALFORMED_CARD", "model", "the network predicts no column");
  }
  POISE_ASSIGN_OR_RETURN(std::vector<float> dct,
                         weights.Floats("dct", std::vector<int64_t>{frames, frames}));
  for (int layer = 0; layer < config_.layers(); ++layer) {
    POISE_RETURN_IF_ERROR(LoadLayer(weights, layer));
  }
  arguments_ = {.nodes = static_cast<int>(columns_.size()),
                .frames = config_.frames(),
                .width = config_.width,
                .blocks = config_.blocks,
                .dct = Keep(std::move(dct)),
                .layers = layers_.data(),
                .batch = 0,
                .motion = nullptr,
                .predicted = nullptr};
  return absl::OkStatus();
}

// The batch norm becomes a scale and a shift per number.
Status GcnPredictor::LoadLayer(const base::TensorFile& weights, int layer) {
  const auto nodes = static_cast<int64_t>(columns_.size());
  const bool first = layer == 0, last = layer == config_.layers() - 1;
  const int64_t inputs = first ? config_.frames() : config_.width;
  const int64_t outputs = last ? config_.frames() : config_.width;
  const auto take = [&](const std::string& name, std::vector<int64_t> shape) {
    return weights.Floats(fmt::format("layer{}_{}", layer, name), shape);
  };
  POISE_ASSIGN_OR_RETURN(std::vector<float> graph, take("graph", {nodes, nodes}));
  POISE_ASSIGN_OR_RETURN(std::vector<float> weight, take("weight", {inputs, outputs}));
  POISE_ASSIGN_OR_RETURN(std::vector<float> bias, take("bias", {outputs}));
  GcnLayer loaded{Keep(std::move(graph)), Keep(std::move(weight)), Keep(std::move(bias)), nullptr,
                  nullptr};
  if (!last) {
    const std::vector<int64_t> shape = {nodes * outputs};
    POISE_ASSIGN_OR_RETURN(std::vector<float> scale, take("norm.weight", shape));
    POISE_ASSIGN_OR_RETURN(std::vector<float> shift, take("norm.bias", shape));
    POISE_ASSIGN_OR_RETURN(const std::vector<float> mean, take("norm.running_mean", shape));
    POISE_ASSIGN_OR_RETURN(const std::vector<float> variance, take("norm.running_var", shape));
    for (size_t i = 0; i < scale.size(); ++i) {
      scale[i] /= std::sqrt(variance[i] + kNormEpsilon);
      shift[i] -= mean[i] * scale[i];
    }
    loaded.scale = Keep(std::move(scale));
    loaded.shift = Keep(std::move(shift));
  }
  layers_.push_back(loaded);
  return absl::OkStatus();
}

void GcnPredictor::WriteMotion(const Clip& past, float* motion) const {
  const int last = past.num_frames() - 1, first = past.num_frames() - config_.past_frames;
  std::vector<Vec3> vectors(body_.joints.size());
  for (int frame = 0; frame < config_.frames(); ++frame) {
    const int seen = std::min(first + frame, last);
    for (size_t j = 0; j < vectors.size(); ++j) {
      vectors[j] = sense_ * math::ToRotationVector(past.rotation(seen, body_.joints[j]));
    }
    for (const int column : columns_) {
      *motion++ = static_cast<float>(vectors[column / 3][column % 3]);
    }
  }
}

StatusOr<Clip> GcnPredictor::Decode(const Clip& past, const float* future,
                                    int future_frames) const {
  const int last = past.num_frames() - 1;
  std::vector<Vec3> vectors;
  for (const int joint : body_.joints) {
    vectors.push_back(sense_ * math::ToRotationVector(past.rotation(last, joint)));
  }
  std::vector<Quat> rotations;
  rotations.reserve(static_cast<size_t>(future_frames) * past.num_joints());
  for (int frame = 0; frame < future_frames; ++frame) {
    for (const int column : columns_) vectors[column / 3][column % 3] = *future++;
    const size_t pose = rotations.size();
    rotations.insert(rotations.end(), past.pose(last).begin(), past.pose(last).end());
    for (size_t j = 0; j < vectors.size(); ++j) {
      rotations[pose + body_.joints[j]] = math::FromRotationVector(sense_ * vectors[j]);
    }
  }
  StatusOr<Clip> clip = Clip::Create(past.name(), past.skeleton(), past.frame_rate(),
                                     std::vector<Vec3>(future_frames, past.root_position(last)),
                                     std::move(rotations));
  if (clip.ok()) return clip;
  return base::Internal("NOT_FINITE",
                        fmt::format("clip '{}': the network's answer is no motion: {}", past.name(),
                                    base::Message(clip.status())));
}

StatusOr<std::vector<Clip>> GcnPredictor::Predict(std::span<const Observation> batch,
                                                  int future_frames,
                                                  const base::RunContext& context) const {
  POISE_RETURN_IF_ERROR(CheckObservations(signature_, batch, future_frames));
  POISE_RETURN_IF_ERROR(context.Check());
  const size_t size = static_cast<size_t>(arguments_.frames) * arguments_.nodes;
  std::vector<float> motion(batch.size() * size), predicted(batch.size() * size);
  for (size_t i = 0; i < batch.size(); ++i) WriteMotion(batch[i].past, motion.data() + i * size);
  GcnArguments arguments = arguments_;
  arguments.batch = static_cast<int>(batch.size());
  arguments.motion = motion.data();
  arguments.predicted = predicted.data();
  RunKernel(arguments);
  const size_t past_size = static_cast<size_t>(config_.past_frames) * arguments_.nodes;
  std::vector<Clip> futures;
  for (size_t i = 0; i < batch.size(); ++i) {
    POISE_ASSIGN_OR_RETURN(
        Clip clip, Decode(batch[i].past, predicted.data() + i * size + past_size, future_frames));
    futures.push_back(std::move(clip));
  }
  return futures;
}

}  // namespace poise::prediction
