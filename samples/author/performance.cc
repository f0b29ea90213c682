#include "samples/author/performance.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "samples/author/limb.h"

namespace poise::samples {
namespace {

using Eigen::AngleAxisd;

constexpr double kDegree = std::numbers::pi / 180;

// The middle between the shoulders, in the chest's frame: origin of an arm's wrist goal.
const Vec3 kShoulderLine(0, 0.185, 0);

Quat AboutX(double degrees) { return Quat(AngleAxisd(degrees * kDegree, Vec3::UnitX())); }
Quat AboutY(double degrees) { return Quat(AngleAxisd(degrees * kDegree, Vec3::UnitY())); }
Quat AboutZ(double degrees) { return Quat(AngleAxisd(degrees * kDegree, Vec3::UnitZ())); }

Quat Turn(const Vec3& turn) { return AboutY(turn.x()) * AboutX(turn.y()) * AboutZ(-turn.z()); }

Vec3 Mirrored(const Vec3& v, Side side) { return Vec3(Outward(side) * v.x(), v.y(), v.z()); }

// Share of the heel rise that the toes undo by bending back; the rest tips them onto their ends.
constexpr double kToeBend = 0.6;

// World rotation of the foot and place of its ankle.
struct FootPose {
  Vec3 ankle;
  Quat rotation;
};

// One frame while it is being solved: world rotations of all joints, world positions of those that
// others hang off.
class FrameSolver {
 public:
  explicit FrameSolver(const motion::Skeleton& skeleton) : skeleton_(skeleton) {}

  void SolveTrunk(const Performance& performance, double time) {
    positions_[kHips] = performance.pelvis(time);
    const Quat pelvis = Turn(performance.pelvis_turn(time));
    const Quat chest = Turn(performance.chest_turn(time));
    const Quat head = Turn(performance.head_turn(time));
    rotations_[kHips] = pelvis;
    rotations_[kSpine] = pelvis.slerp(0.5, chest);
    rotations_[kChest] = chest;
    rotations_[kNeck] = chest.slerp(0.4, head);
    rotations_[kHead] = head;
    for (const int joint : {kSpine, kChest, kNeck, kHead}) Place(joint);
  }

  void SolveLeg(const LegScript& script, Side side, double time) {
    const LegJoints leg = Leg(side);
    Place(leg.hip);
    const FootPose foot = StandFoot(script, side, time);
    const Vec3 roll = script.foot(time);
    const Vec3 knee_forward =
        AboutY(Outward(side) * (roll.x() + script.knee_out(time))) * Vec3::UnitZ();
    LimbPose pose = ReachGoal(positions_[leg.hip], foot.ankle, knee_forward, kThigh, kShank);
    const double weight = script.free.weight(time);
    if (weight > 0) pose = Blend(pose, FreePose(script.free, side, Vec3::UnitX(), time), weight);
    SetLimb(pose, -Vec3::UnitY(), Vec3::UnitX(), leg.hip, leg.knee);
    const Quat free_foot = rotations_[leg.knee] * AboutX(-script.free_dorsiflexion(time));
    rotations_[leg.ankle] = foot.rotation.slerp(weight, free_foot);
    rotations_[leg.toe] = rotations_[leg.ankle] * AboutX(-kToeBend * roll.z() * (1 - weight));
  }

  void SolveArm(const ArmScript& script, Side side, double time) {
    const ArmJoints arm = Arm(side);
    const double out = Outward(side);
    const Vec3 collar = script.collar(time);
    Place(arm.collar);
    rotations_[arm.collar] =
        rotations_[kChest] * AboutY(-out * collar.x()) * AboutZ(out * collar.y());
    Place(arm.shoulder);
    const Vec3 middle = positions_[kChest] + rotations_[kChest] * kShoulderLine;
    LimbPose pose = ReachGoal(positions_[arm.shoulder], middle + Mirrored(script.wrist(time), side),
                              Mirrored(script.elbow(time), side), kUpperArm, kForearm);
    const double weight = script.free.weight(time);
    if (weight > 0) pose = Blend(pose, FreePose(script.free, side, -Vec3::UnitX(), time), weight);
    SetLimb(pose, out * Vec3::UnitX(), -out * Vec3::UnitY(), arm.shoulder, arm.elbow);
    const Vec3 hand = script.hand(time);
    rotations_[arm.wrist] = rotations_[arm.elbow] * AboutX(-hand.x()) * AboutZ(-out * hand.y());
  }

  Vec3 root() const { return positions_[kHips]; }
  Quat Local(int joint) const {
    const int parent = skeleton_.parent(joint);
    const Quat local =
        parent < 0 ? rotations_[joint] : rotations_[parent].conjugate() * rotations_[joint];
    return local.normalized();
  }

 private:
  void Place(int joint) {
    const int parent = skeleton_.parent(joint);
    positions_[joint] = positions_[parent] + rotations_[parent] * skeleton_.joint(joint).offset;
  }

  static FootPose StandFoot(const LegScript& script, Side side, double time) {
    const Vec3 angles = script.foot(time);
    const Quat yaw = AboutY(Outward(side) * angles.x());
    const Quat strike = AboutX(-angles.y());
    const Quat rise = AboutX(angles.z());
    // Seen from the ball's contact point, before the foot is turned about the vertical.
    const Vec3 ball(0, kAnkleHeight + kBallFromAnkle.y(), 0);
    const Vec3 heel(0, 0, -kBallFromAnkle.z() - kHeelBehindAnkle);
    const Vec3 toe(0, 0, kToeLength);
    const Vec3 risen =
        ball + toe - AboutX((1 - kToeBend) * angles.z()) * toe - rise * kBallFromAnkle;
    return {script.ball(time) + yaw * (heel + strike * (risen - heel)), yaw * strike * rise};
  }

  // `flexion_axis`: about which the hinge flexes when the limb hangs down.
  static LimbPose FreePose(const FreeLimb& limb, Side side, const Vec3& flexion_axis, double time) {
    const Vec3 angles = limb.angles(time);
    const Quat swing = AboutX(-angles.x()) * AboutZ(Outward(side) * angles.y());
    const Quat roll = AboutY(Outward(side) * limb.roll(time));
    return {swing * -Vec3::UnitY(), swing * (roll * flexion_axis), angles.z() * kDegree};
  }

  void SetLimb(const LimbPose& pose, const Vec3& rest_bone, const Vec3& rest_hinge, int upper,
               int lower) {
    rotations_[upper] = TurnBone(rest_bone, rest_hinge, pose.upper, pose.hinge);
    rotations_[lower] = TurnBone(rest_bone, rest_hinge, pose.Lower(), pose.hinge);
  }

  const motion::Skeleton& skeleton_;
  std::array<Quat, kNumJoints> rotations_;  // world from joint
  std::array<Vec3, kNumJoints> positions_;  // world
};

// Adding zero turns -0 into 0.
double Round(double value, double step) { return std::round(value / step) * step + 0.0; }

// Numbers as a person would keep them in a file. So the files are the same bytes wherever they are
// written: sines differ in their last bits between machines.
Vec3 RoundPosition(const Vec3& position) {
  return position.unaryExpr([](double metres) { return Round(metres, 1e-7); });
}

Quat RoundRotation(const Quat& rotation) {
  const Vec3 angles = math::ToEuler(rotation, math::kZXY);
  return math::FromEuler(
      angles.unaryExpr([](double angle) { return Round(angle / kDegree, 1e-5) * kDegree; }),
      math::kZXY);
}

}  // namespace

StatusOr<motion::Clip> Perform(const Performance& performance) {
  const motion::SkeletonPtr body = MakeBody();
  const int frames = static_cast<int>(std::lround(performance.seconds * performance.frame_rate));
  std::vector<Vec3> roots;
  std::vector<Quat> rotations;
  for (int frame = 0; frame <= frames; ++frame) {
    const double time = frame / performance.frame_rate;
    FrameSolver solver(*body);
    solver.SolveTrunk(performance, time);
    for (const Side side : kSides) {
      solver.SolveLeg(performance.legs[static_cast<int>(side)], side, time);
      solver.SolveArm(performance.arms[static_cast<int>(side)], side, time);
    }
    roots.push_back(RoundPosition(solver.root()));
    for (int joint = 0; joint < kNumJoints; ++joint) {
      rotations.push_back(RoundRotation(solver.Local(joint)));
    }
  }
  return motion::Clip::Create(performance.name, body, performance.frame_rate, std::move(roots),
                              std::move(rotations));
}

}  // namespace poise::samples
