#include "core/pipeline/load_decoder.h"

#include "core/synthesis/vae/vae_model.h"

namespace poise::pipeline {

StatusOr<MotionDecoderPtr> LoadDecoder(const artifacts::ModelArtifact& model) {
  POISE_ASSIGN_OR_RETURN(MotionDecoderPtr decoder, synthesis::VaeModel::Create(model));
  base::Random random(0);
  const synthesis::LatentSampler sampler = decoder->MakeSampler({});
  POISE_RETURN_IF_ERROR(decoder->Decode(sampler.Draw(random), "warm-up").status());
  return decoder;
}

}  // namespace poise::pipeline
