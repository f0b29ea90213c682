#ifndef POISE_CORE_PIPELINE_LOAD_DECODER_H_
#define POISE_CORE_PIPELINE_LOAD_DECODER_H_

#include "core/artifacts/model_artifact.h"
#include "core/pipeline/augment.h"

namespace poise::pipeline {

/// The network of a model that makes motions (family "vae"), after a first run, which is the
/// slowest. Needs LibTorch: apart from the flows (poise_training). Errors: those of
/// VaeModel::Create.
StatusOr<MotionDecoderPtr> LoadDecoder(const artifacts::ModelArtifact& model);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_LOAD_DECODER_H_
