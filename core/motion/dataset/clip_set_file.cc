#include "core/motion/dataset/clip_set_file.h"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "core/base/json.h"
#include "core/base/tensor_file.h"
#include "core/motion/skeleton_json.h"

namespace poise::motion {
namespace {

using base::Json;

constexpr const char* kMetadata = "clip_set";

std::string PositionsName(size_t clip) { return fmt::format("positions/{:05}", clip); }
std::string RotationsName(size_t clip) { return fmt::format("rotations/{:05}", clip); }

Status Malformed(std::string_view what, std::string_view message) {
  return base::InvalidArgument("MALFORMED_CLIP_SET", "", fmt::format("{}: {}", what, message));
}

base::TensorRecord Positions(const Clip& clip) {
  std::vector<float> values;
  for (const Vec3& position : clip.root_positions()) {
    for (const double x : position) values.push_back(static_cast<float>(x));
  }
  return base::TensorRecord::FromFloats({clip.num_frames(), 3}, values);
}

base::TensorRecord Rotations(const Clip& clip) {
  std::vector<float> values;
  for (const Quat& q : clip.rotations()) {
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) values.push_back(static_cast<float>(x));
  }
  return base::TensorRecord::FromFloats({clip.num_frames(), clip.num_joints(), 4}, values);
}

StatusOr<Clip> ReadClip(const base::TensorFile& file, size_t number, std::string name,
                        SkeletonPtr skeleton, double frame_rate) {
  POISE_ASSIGN_OR_RETURN(const base::TensorRecord* record, file.Find(PositionsName(number)));
  const int64_t frames = record->shape.empty() ? 0 : record->shape[0];
  POISE_ASSIGN_OR_RETURN(const std::vector<float> p,
                         file.Floats(PositionsName(number), std::vector<int64_t>{frames, 3}));
  POISE_ASSIGN_OR_RETURN(
      const std::vector<float> q,
      file.Floats(RotationsName(number), std::vector<int64_t>{frames, skeleton->num_joints(), 4}));
  std::vector<Vec3> positions;
  for (size_t i = 0; i < p.size(); i += 3) positions.emplace_back(p[i], p[i + 1], p[i + 2]);
  std::vector<Quat> rotations;
  for (size_t i = 0; i < q.size(); i += 4)
    rotations.emplace_back(q[i], q[i + 1], q[i + 2], q[i + 3]);
  return Clip::Create(std::move(name), std::move(skeleton), frame_rate, std::move(positions),
                      std::move(rotations));
}

StatusOr<ClipSet> FromJson(const Json& json, const base::TensorFile& file, std::string_view what) {
  ClipSet set;
  set.license = json.at("license");
  set.notes = json.at("notes").get<std::vector<std::string>>();
  std::vector<SkeletonPtr> skeletons;
  for (const Json& entry : json.at("skeletons")) {
    POISE_ASSIGN_OR_RETURN(SkeletonPtr skeleton, SkeletonFromJson(entry));
    skeletons.push_back(std::move(skeleton));
  }
  for (const Json& entry : json.at("clips")) {
    const auto skeleton = base::IntegerFrom<size_t>(entry.at("skeleton"));
    if (skeleton >= skeletons.size()) return Malformed(what, "a clip has no skeleton");
    POISE_ASSIGN_OR_RETURN(Clip clip, ReadClip(file, set.clips.size(), entry.at("name"),
                                               skeletons[skeleton], entry.at("frame_rate")));
    set.clips.push_back({entry.at("action"), entry.at("actor"), std::move(clip)});
  }
  if (set.clips.empty()) return Malformed(what, "there are no clips");
  if (file.tensors.size() != 2 * set.clips.size()) {
    return Malformed(
        what, fmt::format("{} clips have {} tensors", set.clips.size(), file.tensors.size()));
  }
  return set;
}

}  // namespace

std::string EncodeClipSet(const ClipSet& set) {
  base::TensorFile file;
  Json skeletons = Json::array(), clips = Json::array();
  std::vector<SkeletonPtr> known;
  for (const LabelledClip& labelled : set.clips) {
    const Clip& clip = labelled.clip;
    size_t skeleton = 0;
    while (skeleton < known.size() && !known[skeleton]->SameAs(*clip.skeleton(), 0)) ++skeleton;
    if (skeleton == known.size()) {
      known.push_back(clip.skeleton());
      skeletons.push_back(SkeletonToJson(*clip.skeleton()));
    }
    file.tensors[PositionsName(clips.size())] = Positions(clip);
    file.tensors[RotationsName(clips.size())] = Rotations(clip);
    clips.push_back({{"name", clip.name()},
                     {"action", labelled.action},
                     {"actor", labelled.actor},
                     {"skeleton", skeleton},
                     {"frame_rate", clip.frame_rate()}});
  }
  const Json json = {
      {"license", set.license}, {"notes", set.notes}, {"skeletons", skeletons}, {"clips", clips}};
  // File names may hold bytes that are no UTF-8.
  file.metadata[kMetadata] = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return base::EncodeTensors(file);
}

StatusOr<ClipSet> DecodeClipSet(std::string_view bytes, std::string_view what) {
  POISE_ASSIGN_OR_RETURN(const base::TensorFile file, base::DecodeTensors(bytes, what));
  const auto metadata = file.metadata.find(kMetadata);
  if (metadata == file.metadata.end()) return Malformed(what, "tensors, but no set of clips");
  POISE_ASSIGN_OR_RETURN(const Json json, base::ParseJson(metadata->second, what));
  try {
    return FromJson(json, file, what);
  } catch (const Json::exception&) {
    return Malformed(what, "the description of the clips lacks a part");
  }
}

}  // namespace poise::motion
