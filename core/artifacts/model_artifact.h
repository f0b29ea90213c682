#ifndef POISE_CORE_ARTIFACTS_MODEL_ARTIFACT_H_
#define POISE_CORE_ARTIFACTS_MODEL_ARTIFACT_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "core/api/model_card.h"
#include "core/base/status.h"
#include "core/base/tensor_file.h"

namespace poise::artifacts {

/// A trained model: its card and its numbers. On disk a folder with `card.json` (for people) and
/// `weights.safetensors`; on its way one safetensors file with the card in its metadata ("card").
struct ModelArtifact {
  api::ModelCard card;
  base::TensorFile weights;
};

/// SHA-256 over names, types, shapes and numbers, whatever the metadata.
std::string WeightsDigest(const base::TensorFile& weights);

/// One file with everything; sets card.weights_sha256.
std::string PackModel(ModelArtifact model);
/// Errors: kInvalidArgument MISSING_CARD; kDataLoss CORRUPT_MODEL when the weights are not those
/// of the card; those of DecodeTensors and ModelCardFromJson.
StatusOr<ModelArtifact> UnpackModel(std::string_view bytes, std::string_view what);

/// Both files into an existing folder. Errors: kUnavailable CANNOT_STORE.
Status WriteModelFolder(const ModelArtifact& model, const std::filesystem::path& folder);
/// The card alone, cheaply. Errors: kDataLoss CORRUPT_MODEL (a file is missing or malformed).
StatusOr<api::ModelCard> ReadModelCard(const std::filesystem::path& folder);
/// Errors: those of ReadModelCard; also when the weights are not those of the card.
StatusOr<ModelArtifact> ReadModelFolder(const std::filesystem::path& folder);

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_MODEL_ARTIFACT_H_
