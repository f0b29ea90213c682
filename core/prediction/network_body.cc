#include "core/prediction/network_body.h"

#include <fmt/format.h>

#include <exception>

namespace poise::prediction {
namespace {

base::Json VectorJson(const motion::Vec3& v) { return base::Json{v.x(), v.y(), v.z()}; }

motion::Vec3 VectorOf(const base::Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Status Malformed(std::string_view what) {
  return base::InvalidArgument("MALFORMED_CARD", "signature",
                               fmt::format("the model's card does not say whose motion it "
                                           "predicts: {}",
                                           what));
}

StatusOr<NetworkBody> Parse(const base::Json& json) {
  NetworkBody body{.skeleton = nullptr,
                   .frame_rate = json.at("frame_rate").get<double>(),
                   .joints = json.at("joints").get<std::vector<int>>()};
  std::vector<motion::Joint> joints;
  for (const base::Json& entry : json.at("skeleton")) {
    joints.push_back({entry.at("name").get<std::string>(), entry.at("parent").get<int>(),
                      VectorOf(entry.at("offset")), std::nullopt});
    if (entry.contains("end_site")) joints.back().end_site = VectorOf(entry.at("end_site"));
  }
  POISE_ASSIGN_OR_RETURN(body.skeleton, motion::Skeleton::Create(std::move(joints)));
  for (const int joint : body.joints) {
    if (joint < 1 || joint >= body.skeleton->num_joints()) return Malformed("no such joint");
  }
  if (!(body.frame_rate > 0)) return Malformed("no frame rate");
  return body;
}

}  // namespace

NetworkBody NetworkBody::Of(const motion::BenchmarkClips& clips) {
  const motion::Clip& clip = clips.train.front().clip;
  NetworkBody body{.skeleton = clip.skeleton(), .frame_rate = clip.frame_rate(), .joints = {}};
  for (int joint = 1; joint < clip.num_joints(); ++joint) {
    bool counts = false;
    for (int axis = 0; axis < 3; ++axis) counts = counts || clips.counts[3 * joint + axis];
    if (counts) body.joints.push_back(joint);
  }
  return body;
}

base::Json NetworkBody::ToJson() const {
  base::Json bones = base::Json::array();
  for (const motion::Joint& joint : skeleton->joints()) {
    base::Json entry = {
        {"name", joint.name}, {"parent", joint.parent}, {"offset", VectorJson(joint.offset)}};
    if (joint.end_site) entry["end_site"] = VectorJson(*joint.end_site);
    bones.push_back(std::move(entry));
  }
  return {{"frame_rate", frame_rate}, {"joints", joints}, {"skeleton", std::move(bones)}};
}

StatusOr<NetworkBody> NetworkBody::FromJson(const base::Json& json) {
  // The JSON library reports missing keys and wrong types by exceptions.
  try {
    return Parse(json);
  } catch (const base::Json::exception& error) {
    return Malformed(error.what());
  }
}

}  // namespace poise::prediction
