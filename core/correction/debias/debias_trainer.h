#ifndef POISE_CORE_CORRECTION_DEBIAS_DEBIAS_TRAINER_H_
#define POISE_CORE_CORRECTION_DEBIAS_DEBIAS_TRAINER_H_

#include <optional>
#include <string>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/run_context.h"
#include "core/correction/debias/debias_pairs.h"
#include "core/learning/nn/checkpoint_sink.h"

namespace poise::correction {

/// What is learned, from what.
struct DebiasTask {
  std::vector<DebiasClip> train;     ///< originals, all at one rate
  std::vector<DebiasClip> held_out;  ///< for the scores alone; may be empty
  DebiasConfig config;
  // For the card:
  std::string preset = "recommended";
  std::string data = {};
  std::string data_fingerprint = {};
  std::string data_license = {};
  std::string trained_on = {};
};

/// Debiaser::Create makes a debiaser of the model, without LibTorch.
struct DebiasResult {
  artifacts::ModelArtifact model;
  std::string curve_csv;
  std::string curve_svg;
};

/// Lets the character imitate all clips, then learns to undo what that changed, with the seed of
/// `context`. `checkpoint` is what an earlier attempt gave to `sink`; with one thread the result is
/// then the same bit for bit. The card's scores, of the clips learned from and with `held_out_` of
/// the others: `imitated_rad`, `debiased_rad` (mean angle to the original over joints and frames),
/// `imitated_m`, `debiased_m` (of the root). Where choose_l2 applies also `left_out_...`: of each
/// actor learned from, by a map that learned from the rest; if that does not bring them nearer, the
/// model changes nothing.
/// Errors: those of DebiasConfig::Validate, MakeDebiasPairs and learning::Trainer;
/// kFailedPrecondition NOTHING_IMITATED (no clip was completed), MIXED_RATES.
StatusOr<DebiasResult> TrainDebias(const DebiasTask& task, const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint = {},
                                   const learning::CheckpointSink& sink = {});

/// The same from pairs that are there already.
StatusOr<DebiasResult> TrainDebias(const DebiasTask& task, const std::vector<DebiasPair>& train,
                                   const std::vector<DebiasPair>& held_out,
                                   const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint = {},
                                   const learning::CheckpointSink& sink = {});

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_DEBIAS_TRAINER_H_
