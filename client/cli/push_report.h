#ifndef POISE_CLIENT_CLI_PUSH_REPORT_H_
#define POISE_CLIENT_CLI_PUSH_REPORT_H_

#include <string>
#include <vector>

#include "core/api/push_forecast.h"
#include "core/api/push_spec.h"
#include "core/base/json.h"
#include "core/base/status.h"
#include "core/motion/clip.h"

namespace poise::cli {

/// Gathers the frames of a push forecast: clips to write, and what happened to whom.
class PushReport {
 public:
  explicit PushReport(api::PushForecastScene scene);

  /// Frames come in order. Errors: kInternal BAD_ANSWER when the people are not the scene's.
  Status Add(const api::PushForecastFrame& frame);

  int num_people() const { return static_cast<int>(scene_.people.size()); }
  const api::PushForecastPerson& person(int index) const { return scene_.people[index]; }
  /// The motion of one person. Errors: those of Clip::Create.
  StatusOr<motion::Clip> ClipOf(int person) const;

  /// {"people": [{"id", "mass_kg", "onset_s", "peak_hip_mps", "file"}], "min_distance_m"};
  /// onset_s is null for who does not move, min_distance_m for one person alone.
  base::Json ToJson(const std::vector<std::string>& files) const;
  /// The same as a table.
  std::string Text() const;

 private:
  struct Track {
    std::vector<motion::Vec3> root_positions;  // (frames)
    std::vector<motion::Quat> rotations;       // (frames, joints)
    motion::Vec3 hip = motion::Vec3::Zero();   // in the last frame
    double peak_hip_mps = 0;
    std::optional<double> onset_s;
  };

  void MeasureDistances(const api::PushForecastFrame& frame);

  api::PushForecastScene scene_;
  std::vector<Track> tracks_;
  double min_distance_m_;
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_PUSH_REPORT_H_
