#include "core/synthesis/ik/ik_synthesizer.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "core/synthesis/ik/keyframe.h"
#include "core/synthesis/ik/limb.h"
#include "core/synthesis/ik/limb_motion.h"
#include "core/synthesis/ik/propagation.h"
#include "core/synthesis/ik/target_fan.h"

namespace poise::synthesis {
namespace {

using motion::JointRole;
using motion::Vec3;

constexpr int kFramesBetweenChecks = 4096;  // about a millisecond

// The limbs among which the active one is chosen.
struct Candidates {
  LimbKind kind;
  std::optional<Limb> right, left;
  const Limb& limb(Side side) const { return side == Side::kLeft ? *left : *right; }
};

StatusOr<Candidates> FindCandidates(const motion::Clip& clip, const motion::JointRoles& roles,
                                    const ActionClass& action_class, const IkConfig& config) {
  POISE_RETURN_IF_ERROR(roles.Require({JointRole::kPelvis}));
  Candidates candidates{.kind = action_class.limb, .right = {}, .left = {}};
  const bool automatic = config.end_effector == "auto";
  if (!automatic) {
    candidates.kind = config.end_effector.ends_with("wrist") ? LimbKind::kArm : LimbKind::kLeg;
  }
  if (automatic || config.end_effector.starts_with("right")) {
    POISE_ASSIGN_OR_RETURN(candidates.right,
                           FindLimb(*clip.skeleton(), roles, candidates.kind, Side::kRight));
  }
  if (automatic || config.end_effector.starts_with("left")) {
    POISE_ASSIGN_OR_RETURN(candidates.left,
                           FindLimb(*clip.skeleton(), roles, candidates.kind, Side::kLeft));
  }
  return candidates;
}

class BoundIk : public BoundSynthesizer {
 public:
  BoundIk(const Draft& source, const Limb& limb, const Vec3& bend_direction, int keyframe,
          const IkConfig& config)
      : source_(source),
        end_role_(limb.end_role),
        keyframe_(keyframe),
        propagation_(
            Propagate(source.clip.num_frames(), source.clip.frame_rate(), keyframe, config)),
        motion_(source.clip, limb, bend_direction, propagation_.first,
                static_cast<int>(propagation_.weights.size()), config),
        fan_(motion_.base(keyframe), motion_.end(keyframe), config) {}

  StatusOr<Draft> Sample(base::Random& random, const base::RunContext& context) const override {
    const Vec3 target = fan_.Sample(random);
    const LimbMotion::Edit edit = motion_.Plan(keyframe_, target);
    Draft draft{.clip = source_.clip, .ik = {}};
    Vec3 reached = motion_.end(keyframe_);
    for (size_t i = 0; i < propagation_.weights.size(); ++i) {
      if (i % kFramesBetweenChecks == 0) POISE_RETURN_IF_ERROR(context.Check());
      const double weight = propagation_.weights[i];
      if (weight == 0) continue;
      const int frame = propagation_.first + static_cast<int>(i);
      const Vec3 end = motion_.Apply(frame, weight, edit, draft.clip);
      if (frame == keyframe_) reached = end;
    }
    draft.ik = api::IkOutcome{.end_effector = end_role_,
                              .keyframe = keyframe_,
                              .target = target,
                              .reached_error_m = (reached - target).norm(),
                              .reachable = motion_.ReachableShell(keyframe_).Contains(
                                  (target - motion_.base(keyframe_)).norm())};
    return draft;
  }

 private:
  const Draft& source_;
  JointRole end_role_;
  int keyframe_;
  Propagation propagation_;
  LimbMotion motion_;
  TargetFan fan_;
};

}  // namespace

Status IkSynthesizer::Check(const motion::Clip& clip, const motion::JointRoles& roles) const {
  POISE_RETURN_IF_ERROR(FindCandidates(clip, roles, action_class_, config_).status());
  if (clip.num_frames() < kMinFrames) {
    return base::FailedPrecondition(
        "CLIP_TOO_SHORT", "",
        fmt::format("clip '{}' has {} frames, IK synthesis needs at least {}", clip.name(),
                    clip.num_frames(), kMinFrames));
  }
  if (config_.keyframe >= clip.num_frames()) {
    return base::InvalidArgument(
        "KEYFRAME_OUT_OF_RANGE", "",
        fmt::format("'ik.keyframe' is {}, but clip '{}' has frames 0 to {}", config_.keyframe,
                    clip.name(), clip.num_frames() - 1));
  }
  return absl::OkStatus();
}

StatusOr<std::unique_ptr<BoundSynthesizer>> IkSynthesizer::Bind(
    const Draft& source, const motion::JointRoles& roles) const {
  POISE_RETURN_IF_ERROR(Check(source.clip, roles));
  POISE_ASSIGN_OR_RETURN(const Candidates candidates,
                         FindCandidates(source.clip, roles, action_class_, config_));
  const EndEffectorTracks tracks = TrackEndEffectors(source.clip, roles.joint(JointRole::kPelvis),
                                                     candidates.right, candidates.left);
  const Keyframe keyframe = SelectKeyframe(tracks, action_class_.two_sided, config_);
  const Limb& limb = candidates.limb(keyframe.side);
  const Vec3 bend_direction = BendDirection(source.clip, roles, limb, candidates.kind);
  return std::make_unique<BoundIk>(source, limb, bend_direction, keyframe.frame, config_);
}

}  // namespace poise::synthesis
