#include "core/learning/nn/trainer_state.h"

#include <fmt/format.h>

#include "core/learning/nn/module_state.h"

namespace poise::learning {
namespace {

using base::Json;
using base::TensorFile;
using base::TensorRecord;

// Where things stand in a checkpoint.
constexpr std::string_view kWeights = "weights/";
constexpr std::string_view kBest = "best/";
constexpr std::string_view kOptimizer = "optimizer/";
constexpr const char* kState = "state";
constexpr const char* kCurve = "curve";

std::string Prefix(const TrainedNetwork& network) { return network.name + "/"; }

Status Corrupt(std::string_view message) {
  return base::MakeError(absl::StatusCode::kDataLoss, "CORRUPT_CHECKPOINT", "",
                         fmt::format("the checkpoint is none of this training: {}", message));
}

Json StateToJson(const TrainerState& state, const Json& identity) {
  return {{"identity", identity},
          {"steps", state.report.steps},
          {"best_step", state.report.best_step},
          {"best_validation", state.report.best_step < 0 ? 0 : state.report.best_validation},
          {"seconds", state.report.seconds},
          {"failed_validations", state.failed_validations},
          {"recent_sums", state.recent.sums},
          {"recent_count", state.recent.count}};
}

StatusOr<TrainerState> StateFromJson(const Json& json, const Json& identity) {
  TrainerState state;
  try {
    for (const auto& [key, value] : identity.items()) {
      if (json.at("identity").contains(key) && json.at("identity").at(key) == value) continue;
      return base::FailedPrecondition(
          "CHECKPOINT_MISMATCH", "",
          fmt::format("the checkpoint was made with another '{}': {}, now {}", key,
                      json.at("identity").value(key, Json()).dump(), value.dump()));
    }
    state.report.steps = json.at("steps");
    state.report.best_step = json.at("best_step");
    if (state.report.best_step >= 0) state.report.best_validation = json.at("best_validation");
    state.report.seconds = json.at("seconds");
    state.failed_validations = json.at("failed_validations");
    state.recent.sums = json.at("recent_sums").get<std::map<std::string, double>>();
    state.recent.count = json.at("recent_count");
  } catch (const Json::exception&) {
    return Corrupt("it lacks a part of its state");
  }
  return state;
}

void MoveBelow(std::string_view prefix, TensorFile from, TensorFile& to) {
  for (auto& [name, record] : from.tensors) {
    to.tensors.emplace(fmt::format("{}{}", prefix, name), std::move(record));
  }
}

TensorFile TakeBelow(std::string_view prefix, TensorFile& from) {
  TensorFile taken;
  for (auto& [name, record] : from.tensors) {
    if (name.starts_with(prefix)) {
      taken.tensors.emplace(name.substr(prefix.size()), std::move(record));
    }
  }
  return taken;
}

}  // namespace

void TermSums::Add(const std::map<std::string, double>& terms, std::string_view network) {
  for (const auto& [name, value] : terms) sums[fmt::format("{}.{}", network, name)] += value;
}

std::map<std::string, double> TermSums::Means() const {
  std::map<std::string, double> means = sums;
  for (auto& [name, value] : means) value /= static_cast<double>(count);
  return means;
}

StatusOr<TensorFile> ReadNetworks(const std::vector<TrainedNetwork>& networks) {
  TensorFile file;
  for (const TrainedNetwork& network : networks) {
    POISE_RETURN_IF_ERROR(AppendState(*network.module, Prefix(network), file));
  }
  return file;
}

Status WriteNetworks(const TensorFile& file, std::vector<TrainedNetwork>& networks) {
  for (TrainedNetwork& network : networks) {
    POISE_RETURN_IF_ERROR(LoadState(file, Prefix(network), *network.module));
  }
  return absl::OkStatus();
}

StatusOr<std::string> EncodeCheckpoint(const TrainerState& state, const Json& identity,
                                       const std::vector<TrainedNetwork>& networks,
                                       const std::vector<NetworkOptimizer>& optimizers) {
  TensorFile file;
  POISE_ASSIGN_OR_RETURN(TensorFile weights, ReadNetworks(networks));
  MoveBelow(kWeights, std::move(weights), file);
  MoveBelow(kBest, state.best, file);
  for (size_t i = 0; i < networks.size(); ++i) {
    std::string bytes = optimizers[i].Save();
    const auto size = static_cast<int64_t>(bytes.size());
    file.tensors[fmt::format("{}{}", kOptimizer, networks[i].name)] = {
        .type = base::ElementType::kUint8, .shape = {size}, .bytes = std::move(bytes)};
  }
  file.metadata[kState] = StateToJson(state, identity).dump();
  file.metadata[kCurve] = state.curve.ToCsv();
  return base::EncodeTensors(file);
}

StatusOr<TrainerState> DecodeCheckpoint(std::string_view bytes, const Json& identity,
                                        std::vector<TrainedNetwork>& networks,
                                        std::vector<NetworkOptimizer>& optimizers) {
  StatusOr<TensorFile> file = base::DecodeTensors(bytes, "checkpoint");
  if (!file.ok()) return Corrupt(base::Message(file.status()));
  if (!file->metadata.contains(kState) || !file->metadata.contains(kCurve)) {
    return Corrupt("it has no state");
  }
  const StatusOr<Json> json = base::ParseJson(file->metadata[kState], "state");
  if (!json.ok()) return Corrupt(base::Message(json.status()));
  POISE_ASSIGN_OR_RETURN(TrainerState state, StateFromJson(*json, identity));
  StatusOr<LearningCurve> curve = LearningCurve::FromCsv(file->metadata[kCurve]);
  if (!curve.ok()) return Corrupt(base::Message(curve.status()));
  state.curve = *std::move(curve);
  state.best = TakeBelow(kBest, *file);
  if (const Status status = WriteNetworks(TakeBelow(kWeights, *file), networks); !status.ok()) {
    return Corrupt(base::Message(status));
  }
  for (size_t i = 0; i < networks.size(); ++i) {
    const auto record = file->Find(fmt::format("{}{}", kOptimizer, networks[i].name));
    if (!record.ok()) return Corrupt(base::Message(record.status()));
    optimizers[i].Load((*record)->bytes);
  }
  return state;
}

}  // namespace poise::learning
