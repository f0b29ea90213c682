#ifndef POISE_CORE_PUSH_BODY_JOINTS_H_
#define POISE_CORE_PUSH_BODY_JOINTS_H_

#include <array>

/// The 22 joints of the FZJ recordings, on which the push models work (`joint_0` .. `joint_21`).
namespace poise::push {

inline constexpr int kBodyJoints = 22;

inline constexpr int kPelvis = 0;
inline constexpr int kHead = 5;
inline constexpr int kRightHip = 14;
inline constexpr int kRightAnkle = 16;
inline constexpr int kRightToe = 17;
inline constexpr int kLeftHip = 18;
inline constexpr int kLeftAnkle = 20;
inline constexpr int kLeftToe = 21;
inline constexpr std::array kToes = {kRightToe, kLeftToe};

inline constexpr std::array<int, kBodyJoints> kBodyParents = {
    -1, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

/// Pelvis and legs, then trunk, arms and pelvis again: the parts that the paper's models make.
inline constexpr std::array<int, 9> kLowerBody = {0, 14, 15, 16, 17, 18, 19, 20, 21};
inline constexpr std::array<int, 14> kUpperBody = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};

/// Frames per second of the recordings and of every forecast.
inline constexpr double kFrameRate = 60;
inline constexpr double kFrameTime = 1 / kFrameRate;

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_BODY_JOINTS_H_
