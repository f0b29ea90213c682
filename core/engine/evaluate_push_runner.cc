#include "core/engine/evaluate_push_runner.h"

#include <string>
#include <utility>
#include <vector>

#include "core/engine/job_files.h"

namespace poise::engine {
namespace {

base::Json Report(const std::vector<push::ForecasterScores>& scores) {
  base::Json report = base::Json::array();
  for (const push::ForecasterScores& rows : scores) {
    base::Json less = base::Json::object();
    for (const auto& [measure, difference] : rows.less_statue) {
      less[measure] = {{"mean", difference.mean},
                       {"low", difference.low},
                       {"high", difference.high},
                       {"better_share", difference.better_share}};
    }
    const std::vector<push::TakeScores> kept = push::WithoutOutliers(rows.takes);
    report.push_back({{"model", rows.labels.model},
                      {"protocol", rows.labels.protocol},
                      {"set", rows.labels.set},
                      {"takes", rows.takes.size()},
                      {"mean", push::MeanOverTakes(rows.takes)},
                      {"mean_without_outliers", push::MeanOverTakes(kept)},
                      {"less_statue", std::move(less)}});
  }
  return report;
}

class EvaluatePushRunner : public jobs::JobRunner {
 public:
  explicit EvaluatePushRunner(push::PaperForecaster paper) : paper_(std::move(paper)) {}

  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override {
    POISE_ASSIGN_OR_RETURN(const pipeline::EvaluatePushSpec spec,
                           pipeline::EvaluatePushSpec::FromParameters(input.spec.parameters));
    POISE_ASSIGN_OR_RETURN(const std::string takes,
                           ReadInput(input, spec.data_artifact, "spec.parameters.data_artifact"));
    std::string model;
    if (!spec.model_artifact.empty()) {
      POISE_ASSIGN_OR_RETURN(
          model, ReadInput(input, spec.model_artifact, "spec.parameters.model_artifact"));
    }
    base::RunContext run = context.run;
    run.seed = input.seed;
    POISE_ASSIGN_OR_RETURN(const std::vector<push::ForecasterScores> scores,
                           pipeline::EvaluatePush(spec, takes, model, run, paper_));
    jobs::RunOutput output;
    output.report = {{"forecasters", Report(scores)}};
    POISE_RETURN_IF_ERROR(
        WriteOutput(input, "scores.csv", "text/csv", push::PushScoresCsv(scores), output));
    return output;
  }

 private:
  const push::PaperForecaster paper_;
};

}  // namespace

std::unique_ptr<jobs::JobRunner> MakeEvaluatePushRunner(push::PaperForecaster paper) {
  return std::make_unique<EvaluatePushRunner>(std::move(paper));
}

std::unique_ptr<jobs::JobRunner> MakeLightEvaluatePushRunner() {
  return MakeEvaluatePushRunner({});
}

bool EvaluatePushNeedsTorch(const base::Json& parameters) {
  const auto spec = pipeline::EvaluatePushSpec::FromParameters(parameters);
  return spec.ok() && !spec->model_artifact.empty();
}

}  // namespace poise::engine
