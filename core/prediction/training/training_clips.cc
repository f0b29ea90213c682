#include "core/prediction/training/training_clips.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/motion/editing/cut.h"
#include "core/motion/editing/mirror.h"
#include "core/motion/editing/resample.h"
#include "core/motion/joint_roles.h"

namespace poise::prediction {
namespace {

using motion::Clip;

constexpr int kLeastWindows = 4;  // of a sequence that gives some to validation
// Of its duration. At other speeds than 1 the poses lie between the recorded ones, which makes as
// much of a difference as the speed.
constexpr double kSpeeds[] = {0.82, 0.91, 1.1, 1.2};

// Frames at the end of a sequence that are held out.
int HeldOut(int frames, const SplitRules& rules) {
  if (rules.validation_share <= 0 || frames < kLeastWindows * rules.window) return 0;
  return std::max(rules.window, static_cast<int>(frames * rules.validation_share));
}

Status AddVariant(Clip clip, const SplitRules& rules, std::vector<Clip>& variants) {
  if (clip.num_frames() < rules.window) return absl::OkStatus();
  if (rules.mirror) {
    POISE_ASSIGN_OR_RETURN(const motion::JointRoles roles,
                           motion::JointRoles::Detect(*clip.skeleton()));
    POISE_ASSIGN_OR_RETURN(Clip mirrored, motion::Mirror(clip, roles));
    variants.push_back(std::move(mirrored));
  }
  variants.push_back(std::move(clip));
  return absl::OkStatus();
}

StatusOr<std::vector<Clip>> Variants(Clip clip, const SplitRules& rules) {
  std::vector<Clip> variants;
  if (rules.speeds) {
    for (const double speed : kSpeeds) {
      const int frames = std::max(2, static_cast<int>(clip.num_frames() * speed));
      POISE_ASSIGN_OR_RETURN(Clip warped, motion::ResampleToFrames(clip, frames));
      POISE_RETURN_IF_ERROR(AddVariant(std::move(warped), rules, variants));
    }
  }
  POISE_RETURN_IF_ERROR(AddVariant(std::move(clip), rules, variants));
  return variants;
}

}  // namespace

StatusOr<TrainingClips> SplitForTraining(const motion::BenchmarkClips& clips,
                                         const SplitRules& rules) {
  TrainingClips split;
  for (const motion::LabelledClip& labelled : clips.train) {
    const int first = rules.drop_first_frame ? 1 : 0;
    const int frames = labelled.clip.num_frames() - first;
    if (frames < rules.window) continue;
    const int held_out = HeldOut(frames, rules);
    POISE_ASSIGN_OR_RETURN(Clip train, motion::Cut(labelled.clip, first, frames - held_out));
    if (held_out > 0) {
      POISE_ASSIGN_OR_RETURN(Clip validation,
                             motion::Cut(labelled.clip, first + frames - held_out, held_out));
      split.validation.push_back(std::move(validation));
    }
    POISE_ASSIGN_OR_RETURN(std::vector<Clip> variants, Variants(std::move(train), rules));
    split.train.push_back(std::move(variants));
  }
  if (!split.train.empty()) return split;
  return base::FailedPrecondition(
      "NO_WINDOWS", "data",
      fmt::format("none of {} training sequences has {} frames, as one window needs",
                  clips.train.size(), rules.window));
}

}  // namespace poise::prediction
