#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_TRAINER_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_TRAINER_H_

#include <optional>
#include <string>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/checkpoint_sink.h"
#include "core/motion/dataset/labelled_clip.h"
#include "core/synthesis/vae/vae_config.h"
#include "core/synthesis/vae/vae_motions.h"

namespace poise::synthesis {

/// What is learned, from what.
struct VaeTask {
  std::vector<motion::LabelledClip> clips;
  motion::FoldChoice fold;
  VaeConfig config;
  std::string preset = "recommended";
  std::string data;              ///< for the card: name of the data set,
  std::string data_fingerprint;  ///< its fingerprint
  std::string data_license;      ///< and its license
};

struct VaeResult {
  artifacts::ModelArtifact model;
  std::string curve_csv;
  std::string curve_svg;
  std::string latent_map_svg;  ///< LatentMap of the training motions and 200 samples near them
};

/// Learns one VAE (reference sec. 2) with the seed of `context`. `checkpoint` is what an earlier
/// attempt gave to `sink`; with one thread the result is then the same bit for bit.
/// The card's scores: `reconstruction_rad` and `reconstruction_m`, mean geodesic error of all
/// joints and mean distance of the root when motions are encoded to the mean and decoded; the same
/// with `held_out_` of the actor who was held out; of a GAN there are none. Errors: those of
/// VaeConfig::Validate, PrepareFold and learning::Trainer.
StatusOr<VaeResult> TrainVae(const VaeTask& task, const base::RunContext& context,
                             const std::optional<std::string>& checkpoint = {},
                             const learning::CheckpointSink& sink = {});

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_TRAINER_H_
