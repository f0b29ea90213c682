#include "core/motion/skeleton_json.h"

#include <utility>

namespace poise::motion {
namespace {

using base::Json;

Json VectorToJson(const Vec3& vector) { return Json::array({vector.x(), vector.y(), vector.z()}); }

Vec3 VectorFromJson(const Json& json) {
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

Joint JointFromJson(const Json& json) {
  Joint joint{.name = json.at("name"),
              .parent = base::IntegerFrom<int>(json.at("parent")),
              .offset = VectorFromJson(json.at("offset")),
              .end_site = {}};
  if (json.contains("end_site")) joint.end_site = VectorFromJson(json.at("end_site"));
  return joint;
}

}  // namespace

Json SkeletonToJson(const Skeleton& skeleton) {
  Json joints = Json::array();
  for (const Joint& joint : skeleton.joints()) {
    Json entry = {
        {"name", joint.name}, {"parent", joint.parent}, {"offset", VectorToJson(joint.offset)}};
    if (joint.end_site) entry["end_site"] = VectorToJson(*joint.end_site);
    joints.push_back(std::move(entry));
  }
  return joints;
}

StatusOr<SkeletonPtr> SkeletonFromJson(const Json& json) {
  std::vector<Joint> joints;
  try {
    for (const Json& entry : json) joints.push_back(JointFromJson(entry));
  } catch (const Json::exception&) {
    return base::InvalidArgument("MALFORMED_SKELETON", "skeleton",
                                 "a joint needs name, parent and offset");
  }
  return Skeleton::Create(std::move(joints));
}

}  // namespace poise::motion
