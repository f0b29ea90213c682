#ifndef POISE_CORE_API_DATA_SET_H_
#define POISE_CORE_API_DATA_SET_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "core/base/json.h"
#include "core/base/status.h"

namespace poise::api {

/// Training data that a user registered under a name. What is behind a name never changes.
struct DataSet {
  std::string name;
  std::string artifact;  ///< "artifacts/<sha256>": the clips (motion/dataset/clip_set_file.h)
  int64_t size_bytes = 0;
  int clips = 0;
  int64_t frames = 0;
  double duration_s = 0;
  std::map<std::string, int> actions;  ///< clips of each
  std::map<std::string, int> actors;
  std::string license;
  std::vector<std::string> notes;
  absl::Time create_time = absl::UnixEpoch();  ///< to the second

  /// SHA-256 of the clips, as it stands in model cards.
  std::string fingerprint() const;
  bool operator==(const DataSet&) const = default;
};

base::Json ToJson(const DataSet& set);
/// Errors: kInvalidArgument MALFORMED_DATA_SET.
StatusOr<DataSet> DataSetFromJson(const base::Json& json);

}  // namespace poise::api

#endif  // POISE_CORE_API_DATA_SET_H_
