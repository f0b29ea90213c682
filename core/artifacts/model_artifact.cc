#include "core/artifacts/model_artifact.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "core/base/sha256.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCardKey = "card";
constexpr const char* kCardFile = "card.json";
constexpr const char* kWeightsFile = "weights.safetensors";
constexpr int kIndent = 2;

Status Corrupt(std::string_view what, std::string_view message) {
  return base::MakeError(absl::StatusCode::kDataLoss, "CORRUPT_MODEL", "model",
                         fmt::format("model {}: {}", what, message));
}

Status CheckDigest(const ModelArtifact& model, std::string_view what) {
  if (WeightsDigest(model.weights) == model.card.weights_sha256) return absl::OkStatus();
  return Corrupt(what, "the weights are not those that the card was written for");
}

Status WriteFile(const fs::path& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (file.good()) return absl::OkStatus();
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_STORE", "",
                         fmt::format("cannot write '{}'", path.string()));
}

StatusOr<std::string> ReadFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (file.good()) return std::move(bytes).str();
  return Corrupt(path.parent_path().string(),
                 fmt::format("cannot read {}", path.filename().string()));
}

}  // namespace

std::string WeightsDigest(const base::TensorFile& weights) {
  return base::Sha256Hex(base::EncodeTensors({.tensors = weights.tensors, .metadata = {}}));
}

std::string PackModel(ModelArtifact model) {
  model.card.weights_sha256 = WeightsDigest(model.weights);
  model.weights.metadata[kCardKey] = api::ToJson(model.card).dump();
  return base::EncodeTensors(model.weights);
}

StatusOr<ModelArtifact> UnpackModel(std::string_view bytes, std::string_view what) {
  ModelArtifact model;
  POISE_ASSIGN_OR_RETURN(model.weights, base::DecodeTensors(bytes, what));
  const auto card = model.weights.metadata.find(kCardKey);
  if (card == model.weights.metadata.end()) {
    return base::InvalidArgument(
        "MISSING_CARD", "model",
        fmt::format("{}: tensors without a model card in their metadata", what));
  }
  POISE_ASSIGN_OR_RETURN(const base::Json json, base::ParseJson(card->second, what));
  POISE_ASSIGN_OR_RETURN(model.card, api::ModelCardFromJson(json));
  model.weights.metadata.erase(card);
  POISE_RETURN_IF_ERROR(CheckDigest(model, what));
  return model;
}

Status WriteModelFolder(const ModelArtifact& model, const fs::path& folder) {
  api::ModelCard card = model.card;
  card.weights_sha256 = WeightsDigest(model.weights);
  POISE_RETURN_IF_ERROR(WriteFile(folder / kCardFile, api::ToJson(card).dump(kIndent) + "\n"));
  return WriteFile(folder / kWeightsFile, base::EncodeTensors(model.weights));
}

StatusOr<api::ModelCard> ReadModelCard(const fs::path& folder) {
  POISE_ASSIGN_OR_RETURN(const std::string text, ReadFile(folder / kCardFile));
  const StatusOr<base::Json> json = base::ParseJson(text, kCardFile);
  if (!json.ok()) return Corrupt(folder.string(), base::Message(json.status()));
  StatusOr<api::ModelCard> card = api::ModelCardFromJson(*json);
  if (!card.ok()) return Corrupt(folder.string(), base::Message(card.status()));
  return card;
}

StatusOr<ModelArtifact> ReadModelFolder(const fs::path& folder) {
  ModelArtifact model;
  POISE_ASSIGN_OR_RETURN(model.card, ReadModelCard(folder));
  POISE_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(folder / kWeightsFile));
  StatusOr<base::TensorFile> weights = base::DecodeTensors(bytes, kWeightsFile);
  if (!weights.ok()) return Corrupt(folder.string(), base::Message(weights.status()));
  model.weights = *std::move(weights);
  POISE_RETURN_IF_ERROR(CheckDigest(model, folder.string()));
  return model;
}

}  // namespace poise::artifacts
