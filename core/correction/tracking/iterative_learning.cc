#include "core/correction/tracking/iterative_learning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/math/low_pass.h"

namespace poise::correction {
namespace {

using physics::kMaxSpeeds;
using physics::Speeds;

// Moves what is learned by the lag of a rollout, met earlier.
void Learn(const std::vector<Speeds>& lags, double frame_rate, const LearningConfig& config,
           std::vector<Speeds>& offsets) {
  const auto lead = static_cast<size_t>(std::lround(config.lead_s * frame_rate));
  std::vector<double> channel(lags.size());
  for (int k = 0; k < kMaxSpeeds; ++k) {
    const bool wrench = k < 6;
    for (size_t frame = 0; frame < lags.size(); ++frame) {
      channel[frame] = lags[std::min(frame + (wrench ? 0 : lead), lags.size() - 1)][k];
    }
    math::LowPassZeroPhase(channel, frame_rate, config.cutoff_hz);
    const double gain = wrench ? config.wrench_gain : config.joint_gain;
    for (size_t frame = 0; frame < lags.size(); ++frame) {
      offsets[frame][k] += gain * channel[frame];
    }
  }
}

// Of the PD-residual's gains in the next rollout.
double NextScale(bool completed, double scale, const LearningConfig& config) {
  if (!completed) return std::min(scale / config.residual_decay, 1.0);
  return std::min(scale, std::max(scale * config.residual_decay, config.residual_least));
}

double Merit(const TrackingScore& score, const LearningConfig& config) {
  return (score.completed ? 1 : 0) + score.reward_normalised -
         config.force_weight * score.residual_force_mean_bw;
}

bool IsBetter(const TrackingScore& score, const TrackingScore& best, const TrackingScore& first,
              const LearningConfig& config) {
  if (first.completed && score.reward_normalised < first.reward_normalised) return false;
  return Merit(score, config) > Merit(best, config);
}

}  // namespace

StatusOr<LearningConfig> LearningConfig::FromPreset(std::string_view preset) {
  LearningConfig config;
  if (preset == "recommended") return config;
  if (preset != "paper") {
    return base::InvalidArgument(
        "UNKNOWN_PRESET", "preset",
        fmt::format("unknown preset '{}', expected recommended or paper", preset));
  }
  config.rollouts = 8;
  config.joint_gain = 0.5;
  config.wrench_gain = 0.25;
  config.lead_s = 0.033;
  config.residual_decay = 1;
  config.force_weight = 0.3;
  return config;
}

std::vector<base::Field> LearningConfig::Fields() {
  return {
      base::Number("rollouts", &rollouts, 1, 1000),
      base::Number("joint_gain", &joint_gain, 0, 1),
      base::Number("wrench_gain", &wrench_gain, 0, 1),
      base::Number("lead_s", &lead_s, 0, 1),
      base::Number("cutoff_hz", &cutoff_hz, 0.1, 1000),
      base::Number("residual_decay", &residual_decay, 0.01, 1),
      base::Number("residual_least", &residual_least, 0, 1),
      base::Number("force_weight", &force_weight, 0, 100),
  };
}

StatusOr<Learned> LearnIteratively(MotionTracker& tracker, const ReferenceMotion& reference,
                                   const LearningConfig& config, const base::RunContext& context,
                                   const Commander& steered) {
  LearningConfig checked = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  TrackingOffsets offsets(reference.num_frames(), Speeds::Zero());
  double residual_scale = 1;
  const Commander commander = [&](const TrackingEpisode& episode) {
    FrameCommand command = steered ? steered(episode) : FrameCommand();
    command.offset += offsets[episode.frame()];
    command.residual_scale *= residual_scale;
    return command;
  };
  POISE_ASSIGN_OR_RETURN(Recording first, tracker.Track(reference, context, commander));
  Learned learned{.best = first, .scores = {first.score}};
  std::vector<Speeds> lags = std::move(first.lags);
  while (static_cast<int>(learned.scores.size()) < config.rollouts) {
    Learn(lags, reference.frame_rate(), config, offsets);
    residual_scale = NextScale(learned.scores.back().completed, residual_scale, config);
    auto next = tracker.Track(reference, context, commander);
    if (absl::IsDeadlineExceeded(next.status())) {
      learned.timed_out = true;
      break;
    }
    if (absl::IsCancelled(next.status())) return next.status();
    if (!next.ok()) break;
    learned.scores.push_back(next->score);
    lags = std::move(next->lags);
    if (IsBetter(next->score, learned.best.score, learned.scores.front(), config)) {
      learned.best = *std::move(next);
    }
    context.Report({.step = static_cast<int64_t>(learned.scores.size()),
                    .total = config.rollouts,
                    .message = "rollout",
                    .metrics = {{"reward", learned.scores.back().reward_normalised},
                                {"force", learned.scores.back().residual_force_mean_bw},
                                {"torque", learned.scores.back().residual_torque_mean_nm}}});
  }
  learned.best.lags.clear();
  return learned;
}

}  // namespace poise::correction
