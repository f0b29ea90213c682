#include "client/cli/push_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "client/cli/table.h"

namespace poise::cli {

PushReport::PushReport(api::PushForecastScene scene)
    : scene_(std::move(scene)),
      tracks_(scene_.people.size()),
      min_distance_m_(std::numeric_limits<double>::infinity()) {}

Status PushReport::Add(const api::PushForecastFrame& frame) {
  if (frame.people.size() != tracks_.size()) {
    return base::Internal("BAD_ANSWER",
                          fmt::format("frame {} has {} people, the scene has {}", frame.index,
                                      frame.people.size(), tracks_.size()));
  }
  for (size_t i = 0; i < tracks_.size(); ++i) {
    const api::PushPersonFrame& person = frame.people[i];
    Track& track = tracks_[i];
    if (!track.root_positions.empty()) {
      motion::Vec3 step = person.hip - track.hip;
      step.y() = 0;
      track.peak_hip_mps = std::max(track.peak_hip_mps, step.norm() * scene_.frame_rate);
    }
    track.hip = person.hip;
    track.onset_s = person.onset_s;
    track.root_positions.push_back(person.root_position);
    track.rotations.insert(track.rotations.end(), person.rotations.begin(), person.rotations.end());
  }
  MeasureDistances(frame);
  return absl::OkStatus();
}

void PushReport::MeasureDistances(const api::PushForecastFrame& frame) {
  std::vector<int> by_x(frame.people.size());
  std::iota(by_x.begin(), by_x.end(), 0);
  const auto hip = [&](int i) -> const motion::Vec3& { return frame.people[by_x[i]].hip; };
  std::sort(by_x.begin(), by_x.end(),
            [&](int a, int b) { return frame.people[a].hip.x() < frame.people[b].hip.x(); });
  for (int i = 0; i < static_cast<int>(by_x.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(by_x.size()); ++j) {
      const double along = hip(j).x() - hip(i).x();
      if (along >= min_distance_m_) break;
      min_distance_m_ = std::min(min_distance_m_, std::hypot(along, hip(j).z() - hip(i).z()));
    }
  }
}

StatusOr<motion::Clip> PushReport::ClipOf(int person) const {
  const Track& track = tracks_[person];
  return motion::Clip::Create(scene_.people[person].id, scene_.people[person].skeleton,
                              scene_.frame_rate, track.root_positions, track.rotations);
}

base::Json PushReport::ToJson(const std::vector<std::string>& files) const {
  base::Json people = base::Json::array();
  for (int i = 0; i < num_people(); ++i) {
    base::Json person = {{"id", scene_.people[i].id},
                         {"mass_kg", scene_.people[i].mass_kg},
                         {"onset_s", nullptr},
                         {"peak_hip_mps", tracks_[i].peak_hip_mps},
                         {"file", files[i]}};
    if (tracks_[i].onset_s) person["onset_s"] = *tracks_[i].onset_s;
    people.push_back(std::move(person));
  }
  base::Json json = {{"model", scene_.model},
                     {"frames", scene_.frames},
                     {"people", std::move(people)},
                     {"min_distance_m", nullptr}};
  if (std::isfinite(min_distance_m_)) json["min_distance_m"] = min_distance_m_;
  return json;
}

std::string PushReport::Text() const {
  Table table({"person", "moves after s", "peak hip m/s", "hip moves m"});
  for (int i = 0; i < num_people(); ++i) {
    const Track& track = tracks_[i];
    const double moved = track.root_positions.empty()
                             ? 0
                             : (track.root_positions.back() - track.root_positions[0]).norm();
    table.AddRow({scene_.people[i].id,
                  track.onset_s ? fmt::format("{:.3f}", *track.onset_s) : "never",
                  fmt::format("{:.2f}", track.peak_hip_mps), fmt::format("{:.2f}", moved)});
  }
  return table.Text();
}

}  // namespace poise::cli
