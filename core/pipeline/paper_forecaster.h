#ifndef POISE_CORE_PIPELINE_PAPER_FORECASTER_H_
#define POISE_CORE_PIPELINE_PAPER_FORECASTER_H_

#include "core/push/evaluation/evaluate_push.h"

namespace poise::pipeline {

/// For EvaluatePush, of programs with LibTorch.
push::PaperForecaster MakePaperForecaster();

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_PAPER_FORECASTER_H_
