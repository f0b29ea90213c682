#ifndef POISE_CORE_API_MODEL_CARD_H_
#define POISE_CORE_API_MODEL_CARD_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "core/base/status.h"
#include "core/motion/motion_signature.h"

namespace poise::api {

/// All that must be known to rebuild a network, to feed it and to trust it. Written once, when the
/// training ends; a loader builds from the card, never from today's defaults.
struct ModelCard {
  std::string family;                        ///< which code builds it: "vae", "gcn", ...
  std::string preset;                        ///< the named settings that `config` began as
  base::Json config = base::Json::object();  ///< every setting of the family, in full
  motion::MotionSignature signature;
  /// What the family subtracts, divides by, and so on; its names and shapes are the family's.
  base::Json normalisation = base::Json::object();

  std::string data;              ///< name of the data set
  std::string data_fingerprint;  ///< SHA-256 of its content
  std::string trained_on;        ///< what of it: "class kick, actors bd bk dg mm (tr held out)"
  std::string data_license;
  uint64_t seed = 0;
  int64_t steps = 0;                     ///< optimiser steps taken
  std::map<std::string, double> scores;  ///< on held-out data, by metric
  std::string program_version;           ///< of the Poise that trained it
  std::string weights_sha256;            ///< of the tensors' names, shapes and numbers

  bool operator==(const ModelCard&) const = default;
};

base::Json ToJson(const ModelCard& card);
/// Errors: kInvalidArgument MALFORMED_CARD naming the key; those of SignatureFromJson.
StatusOr<ModelCard> ModelCardFromJson(const base::Json& json);

/// Which model: "NAME" (its default version) or "NAME@VERSION".
struct ModelReference {
  std::string name;
  std::string version;  ///< empty: the default

  /// Errors: kInvalidArgument BAD_MODEL_NAME.
  static StatusOr<ModelReference> Parse(std::string_view text);
  std::string ToString() const { return version.empty() ? name : name + "@" + version; }
};

/// 1 to 64 of a-z, 0-9, '-', '_' and '.', beginning with a letter or digit: safe as a folder.
/// Errors: kInvalidArgument with this reason and field "name".
Status CheckResourceName(std::string_view name, std::string_view reason);

/// A model as the registry has it.
struct Model {
  std::string name;
  std::string version;  ///< "1", "2", ... in the order of their import
  ModelCard card;
  int64_t size_bytes = 0;
  bool is_default = false;  ///< what the bare name means
  bool shipped = false;     ///< came with the program: cannot be deleted
};

base::Json ToJson(const Model& model);

}  // namespace poise::api

#endif  // POISE_CORE_API_MODEL_CARD_H_
