#include "core/motion/io/smpl_skeleton.h"

namespace poise::motion {

std::vector<Joint> SmplJoints() {
  return {
      {"pelvis", -1, Vec3(0, 0, 0), {}},
      {"left_hip", 0, Vec3(0.08, -0.08, 0), {}},
      {"right_hip", 0, Vec3(-0.08, -0.08, 0), {}},
      {"spine1", 0, Vec3(0, 0.11, -0.02), {}},
      {"left_knee", 1, Vec3(0.03, -0.40, 0), {}},
      {"right_knee", 2, Vec3(-0.03, -0.40, 0), {}},
      {"spine2", 3, Vec3(0, 0.13, 0.01), {}},
      {"left_ankle", 4, Vec3(-0.01, -0.41, -0.03), {}},
      {"right_ankle", 5, Vec3(0.01, -0.41, -0.03), {}},
      {"spine3", 6, Vec3(0, 0.06, 0.01), {}},
      {"left_foot", 7, Vec3(0.03, -0.06, 0.12), Vec3(0, 0, 0.07)},
      {"right_foot", 8, Vec3(-0.03, -0.06, 0.12), Vec3(0, 0, 0.07)},
      {"neck", 9, Vec3(0, 0.20, -0.03), {}},
      {"left_collar", 9, Vec3(0.07, 0.11, -0.02), {}},
      {"right_collar", 9, Vec3(-0.07, 0.11, -0.02), {}},
      {"head", 12, Vec3(0, 0.09, 0.04), Vec3(0, 0.18, 0.01)},
      {"left_shoulder", 13, Vec3(0.12, 0.04, -0.01), {}},
      {"right_shoulder", 14, Vec3(-0.12, 0.04, -0.01), {}},
      {"left_elbow", 16, Vec3(0.27, -0.01, -0.02), {}},
      {"right_elbow", 17, Vec3(-0.27, -0.01, -0.02), {}},
      {"left_wrist", 18, Vec3(0.26, 0.01, 0), Vec3(0.17, 0, 0)},
      {"right_wrist", 19, Vec3(-0.26, 0.01, 0), Vec3(-0.17, 0, 0)},
  };
}

}  // namespace poise::motion
