#ifndef POISE_CORE_PIPELINE_EVALUATE_PUSH_H_
#define POISE_CORE_PIPELINE_EVALUATE_PUSH_H_

#include <string_view>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/pipeline/push_learning_spec.h"
#include "core/push/evaluation/evaluate_push.h"

namespace poise::pipeline {

/// Scores a packed model (empty: none) on the test takes of a take file, beside what needs no
/// learning. Errors: those of DecodeTakes, UnpackModel and push::EvaluatePush.
StatusOr<std::vector<push::ForecasterScores>> EvaluatePush(const EvaluatePushSpec& spec,
                                                           std::string_view take_file,
                                                           std::string_view packed_model,
                                                           const base::RunContext& context,
                                                           const push::PaperForecaster& paper = {});

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_EVALUATE_PUSH_H_
