#ifndef POISE_CORE_PUSH_RESTORATION_STEP_PLANNER_H_
#define POISE_CORE_PUSH_RESTORATION_STEP_PLANNER_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/base/config_fields.h"
#include "core/push/ground_frame.h"

namespace poise::push {

/// When and how feet step. Own design; chosen on the validation takes.
struct StepConfig {
  bool enabled = true;        ///< false: feet go where the networks put them, and slide
  double probability = 0.17;  ///< [0 to 1] of swinging, above which a foot steps
  double shortest_m = 0.08;   ///< [m, 0 to 1] a step to a place nearer than this is not made
  double farthest_m = 0.33;   ///< [m, 0.05 to 2] a foot this far from where it should be steps
  /// [m, 0.02 to 5] who leans this far, for so long, steps under the hip, whatever the networks
  /// say: the hip has come away as far from where it was over either foot.
  double balance_m = 0.15;
  int balance_frames = 20;     ///< [frames, 0 to 600]
  double frames = 15;          ///< [frames, 4 to 60] that a swing takes
  double frames_per_m = 12.5;  ///< [frames/m, 0 to 60] longer, the farther it goes
  double lift_m = 0.026;       ///< [m, 0 to 0.3] height of the toe in the middle of a swing
  double lift_share = 0.1;     ///< [0 to 1] higher, the farther it goes: share of the way
  double aimed_share = 1;      ///< [0 to 1] of a swing in which its goal may still change
  int rest_frames = 3;         ///< [frames, 0 to 60] that a foot stands before it steps again

  std::vector<base::Field> Fields();
};

/// What is wanted of a foot in a frame.
struct FootWish {
  double swings = 0;         ///< [0 to 1] probability that it is on its way
  Eigen::Vector2d foothold;  ///< where its toe stands, or will stand once it has come down [m]
  Eigen::Vector2d balance;   ///< where its toe would stand to the hip as in frame 0 [m]
};

/// Decides which foot of a person swings when, so that a foot stays exactly where it stands until
/// it steps, and one foot stands at any time. The mean of an ensemble blurs steps: a foot that half
/// of the members have on its way slides. This decides. Frame by frame; feet are right, left.
class StepPlanner {
 public:
  /// Both feet stand; `toes` [m] also say how high the floor is under each.
  explicit StepPlanner(const std::array<Vec3, 2>& toes);

  /// Goes to the next frame. `may_begin`: a foot that stands may
  /// leave; who comes to rest only ends what it has begun.
  void Step(const StepConfig& config, const std::array<FootWish, 2>& wishes, bool may_begin);

  /// Where the toes now are [m].
  const std::array<Vec3, 2>& toes() const { return toes_; }
  bool swinging() const { return swings_[0] || swings_[1]; }

 private:
  static constexpr int kLong = 1000;

  struct Swing {
    double progress = 0;  // [0 to 1] in time
    double frames = 0;
    double lift = 0;          // [m]
    bool to_balance = false;  // else to the foothold
    Eigen::Vector2d goal;
  };

  void Advance(const StepConfig& config, int foot, const FootWish& wish);
  void BeginOne(const StepConfig& config, const std::array<FootWish, 2>& wishes);
  void Begin(const StepConfig& config, int foot, bool to_balance, const FootWish& wish);

  std::array<Vec3, 2> toes_;
  std::array<double, 2> floor_;  // height of toes that stand
  std::array<std::optional<Swing>, 2> swings_;
  std::array<int, 2> stood_ = {kLong, kLong};  // [frames]
  int leaning_ = 0;                            // [frames] out of balance
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_RESTORATION_STEP_PLANNER_H_
