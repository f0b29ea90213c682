#include "core/prediction/network_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "core/motion/skeleton_json.h"

namespace poise::prediction {
namespace {

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
  POISE_ASSIGN_OR_RETURN(body.skeleton, motion::SkeletonFromJson(json.at("skeleton")));
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

motion::MotionSignature NetworkBody::Signature() const {
  motion::MotionSignature signature{.roles = {},
                                    .rotation = motion::RotationRepresentation::kExponentialMap,
                                    .frame_rate = frame_rate};
  const auto roles = motion::JointRoles::Detect(*skeleton);
  for (int joint = 0; roles.ok() && joint < skeleton->num_joints(); ++joint) {
    const bool predicted =
        joint == 0 || std::find(joints.begin(), joints.end(), joint) != joints.end();
    const auto role = roles->role(joint);
    if (predicted && role) signature.roles.push_back(*role);
  }
  return signature;
}

base::Json NetworkBody::ToJson() const {
  return {{"frame_rate", frame_rate},
          {"joints", joints},
          {"skeleton", motion::SkeletonToJson(*skeleton)}};
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
