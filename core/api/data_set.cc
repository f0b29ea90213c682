#include "core/api/data_set.h"

namespace poise::api {
namespace {

// Clips by name of an action or actor.
std::map<std::string, int> Counts(const base::Json& json) {
  std::map<std::string, int> counts;
  for (const auto& [name, count] : json.items()) counts[name] = base::IntegerFrom<int>(count);
  return counts;
}

}  // namespace

std::string DataSet::fingerprint() const { return artifact.substr(artifact.find('/') + 1); }

base::Json ToJson(const DataSet& set) {
  return {
      {"name", set.name},
      {"artifact", set.artifact},
      {"size_bytes", set.size_bytes},
      {"clips", set.clips},
      {"frames", set.frames},
      {"duration_s", set.duration_s},
      {"actions", set.actions},
      {"actors", set.actors},
      {"license", set.license},
      {"notes", set.notes},
      {"create_time", absl::FormatTime(absl::RFC3339_sec, set.create_time, absl::UTCTimeZone())}};
}

StatusOr<DataSet> DataSetFromJson(const base::Json& json) {
  const auto malformed = [] {
    return base::InvalidArgument("MALFORMED_DATA_SET", "", "the record of a data set lacks a part");
  };
  DataSet set;
  try {
    set.name = json.at("name");
    set.artifact = json.at("artifact");
    set.size_bytes = base::IntegerFrom<int64_t>(json.at("size_bytes"));
    set.clips = base::IntegerFrom<int>(json.at("clips"));
    set.frames = base::IntegerFrom<int64_t>(json.at("frames"));
    set.duration_s = json.at("duration_s");
    set.actions = Counts(json.at("actions"));
    set.actors = Counts(json.at("actors"));
    set.license = json.at("license");
    set.notes = json.at("notes").get<std::vector<std::string>>();
    const std::string time = json.at("create_time");
    if (!absl::ParseTime(absl::RFC3339_sec, time, &set.create_time, nullptr)) return malformed();
  } catch (const base::Json::exception&) {
    return malformed();
  }
  return set;
}

}  // namespace poise::api
