#include "core/engine/evaluate_predictor_runner.h"

#include <optional>
#include <utility>

#include "core/engine/job_files.h"
#include "core/pipeline/predictor_evaluation.h"

namespace poise::engine {

StatusOr<jobs::RunOutput> EvaluatePredictorRunner::Run(const jobs::RunInput& input,
                                                       const jobs::JobContext& context) {
  POISE_ASSIGN_OR_RETURN(const auto evaluation,
                         pipeline::PredictorEvaluation::FromParameters(input.spec.parameters));
  const auto read = [&](const std::string& artifact, std::string_view field) {
    return artifact.empty() ? StatusOr<std::string>("") : ReadInput(input, artifact, field);
  };
  POISE_ASSIGN_OR_RETURN(const std::string tested,
                         read(evaluation.data_artifact, "spec.parameters.data_artifact"));
  POISE_ASSIGN_OR_RETURN(const std::string train,
                         read(evaluation.train_artifact, "spec.parameters.train_artifact"));
  POISE_ASSIGN_OR_RETURN(const motion::BenchmarkClips clips, evaluation.Clips(tested, train));
  std::optional<artifacts::ModelArtifact> model;
  if (!evaluation.model_artifact.empty()) {
    POISE_ASSIGN_OR_RETURN(model, ReadModel(input, evaluation.model_artifact, evaluation.model,
                                            "spec.parameters.model_artifact"));
  }
  POISE_ASSIGN_OR_RETURN(
      pipeline::EvaluationReport report,
      pipeline::Evaluate(evaluation, clips, model ? &*model : nullptr, context.run));
  jobs::RunOutput output;
  output.report = std::move(report.summary);
  POISE_RETURN_IF_ERROR(WriteOutput(input, "scores.csv", "text/csv", report.csv, output));
  return output;
}

std::unique_ptr<jobs::JobRunner> MakeEvaluatePredictorRunner() {
  return std::make_unique<EvaluatePredictorRunner>();
}

}  // namespace poise::engine
