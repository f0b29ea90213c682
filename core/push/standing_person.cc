#include "core/push/standing_person.h"

#include <array>
#include <utility>

#include "core/push/body_joints.h"
#include "core/push/ground_frame.h"

namespace poise::push {
namespace {

struct Place {
  const char* name;
  Vec3 ground;  // [m]
};

// In the order of the recordings' joints.
const std::array<Place, kBodyJoints>& Places() {
  static const std::array<Place, kBodyJoints> places = {{
      {"pelvis", {0, 0, 1.113}},
      {"spine", {0.006, 0, 1.220}},
      {"spine_2", {0, 0, 1.318}},
      {"chest", {-0.006, 0, 1.415}},
      {"neck", {-0.002, 0, 1.551}},
      {"head", {0.023, 0, 1.637}},
      {"right_collar", {-0.004, -0.030, 1.491}},
      {"right_shoulder", {-0.001, -0.174, 1.468}},
      {"right_elbow", {0.024, -0.196, 1.198}},
      {"right_wrist", {0.056, -0.208, 0.957}},
      {"left_collar", {-0.004, 0.030, 1.491}},
      {"left_shoulder", {-0.001, 0.174, 1.468}},
      {"left_elbow", {0.024, 0.196, 1.198}},
      {"left_wrist", {0.056, 0.208, 0.957}},
      {"right_hip", {0.004, -0.088, 1.005}},
      {"right_knee", {-0.007, -0.104, 0.538}},
      {"right_ankle", {-0.043, -0.116, 0.101}},
      {"right_toe", {0.137, -0.127, 0.022}},
      {"left_hip", {0.004, 0.088, 1.005}},
      {"left_knee", {-0.007, 0.104, 0.538}},
      {"left_ankle", {-0.043, 0.116, 0.101}},
      {"left_toe", {0.137, 0.127, 0.022}},
  }};
  return places;
}

motion::Clip MakeStandingPerson() {
  std::vector<motion::Joint> joints;
  for (int i = 0; i < kBodyJoints; ++i) {
    const int parent = kBodyParents[i];
    const Vec3 base = parent < 0 ? Places()[i].ground : Places()[parent].ground;
    joints.push_back({.name = Places()[i].name,
                      .parent = parent,
                      .offset = WorldFromGround(Places()[i].ground - base),
                      .end_site = std::nullopt});
  }
  const std::vector<math::Quat> upright(kBodyJoints, math::Quat::Identity());
  return *motion::Clip::Create("person", *motion::Skeleton::Create(std::move(joints)), kFrameRate,
                               {WorldFromGround(Places()[kPelvis].ground)}, upright);
}

}  // namespace

const motion::Clip& StandingPerson() {
  static const motion::Clip person = MakeStandingPerson();
  return person;
}

}  // namespace poise::push
