#include "core/push/evaluation/evaluate_push.h"

#include <utility>

#include "core/push/evaluation/anchors.h"
#include "core/push/ldp/ldp_config.h"

namespace poise::push {
namespace {

using Takes = std::vector<const PushTake*>;

std::string ProtocolOf(const artifacts::ModelArtifact& model) {
  return model.card.config.value("protocol", "B");
}

template <typename Forecast>
std::vector<TakeScores> ScoresOf(const Takes& takes, const Forecast& forecast) {
  std::vector<TakeScores> scores;
  for (const PushTake* take : takes) scores.push_back(ScoreTake(*take, forecast(*take)));
  return scores;
}

StatusOr<std::vector<TakeScores>> StatueScores(const Takes& takes, const std::string& protocol,
                                               const base::RunContext& context) {
  POISE_ASSIGN_OR_RETURN(const auto statue, MakeStatueForecaster({}));
  POISE_ASSIGN_OR_RETURN(const Protocol parsed, ParseProtocol(protocol));
  return EvaluateForecaster(*statue, takes, parsed, context);
}

// Of a model of either method.
StatusOr<std::vector<TakeScores>> ModelScores(const artifacts::ModelArtifact& model,
                                              const Takes& takes, Protocol protocol,
                                              const base::RunContext& context,
                                              const PaperForecaster& paper) {
  if (paper && model.card.family == ldp::kFamily) {
    POISE_ASSIGN_OR_RETURN(const std::vector<ForecastJoints> forecasts,
                           paper(model, takes, protocol, context));
    std::vector<TakeScores> scores;
    for (size_t i = 0; i < takes.size(); ++i) {
      scores.push_back(ScoreTake(*takes[i], forecasts[i]));
    }
    return scores;
  }
  POISE_ASSIGN_OR_RETURN(const auto learned, MakeLearnedForecaster(model));
  return EvaluateForecaster(*learned, takes, protocol, context);
}

Status AddSet(const std::string& set, const std::vector<NamedModel>& models, const Takes& takes,
              const base::RunContext& context, const PaperForecaster& paper,
              std::vector<ForecasterScores>& all) {
  if (takes.empty()) return absl::OkStatus();
  all.push_back({{"nobody_moves", "", set, 0}, ScoresOf(takes, NobodyMoves)});
  all.push_back({{"statue_true_hip", "", set, 0}, ScoresOf(takes, StatueOnTrueHip)});
  const std::string first = models.empty() ? "B" : ProtocolOf(models.front().model);
  POISE_ASSIGN_OR_RETURN(std::vector<TakeScores> statue, StatueScores(takes, first, context));
  all.push_back({{"statue", first, set, 0}, std::move(statue)});
  for (const NamedModel& named : models) {
    const std::string protocol = ProtocolOf(named.model);
    POISE_ASSIGN_OR_RETURN(const Protocol parsed, ParseProtocol(protocol));
    POISE_ASSIGN_OR_RETURN(std::vector<TakeScores> scores,
                           ModelScores(named.model, takes, parsed, context, paper));
    POISE_ASSIGN_OR_RETURN(const std::vector<TakeScores> still,
                           StatueScores(takes, protocol, context));
    ForecasterScores& added = all.emplace_back(
        ForecasterScores{{named.name, protocol, set, named.model.card.seed}, std::move(scores)});
    for (const char* measure : {"mpjpe", "hipade", "hipfde", "pose_only"}) {
      added.less_statue[measure] = Compare(added.takes, still, measure, context.seed);
    }
    if (named.model.card.family != kModelFamily) continue;
    POISE_ASSIGN_OR_RETURN(const PushNetworks networks, PushNetworks::Read(named.model));
    const auto on_true_hip = [&](const PushTake& take) {
      return ForecastOnTrueHip(networks, take);
    };
    all.push_back(
        {{named.name + "_true_hip", "", set, named.model.card.seed}, ScoresOf(takes, on_true_hip)});
  }
  return absl::OkStatus();
}

}  // namespace

StatusOr<std::vector<ForecasterScores>> EvaluatePush(const std::vector<NamedModel>& models,
                                                     std::span<const PushTake* const> takes,
                                                     const base::RunContext& context,
                                                     const PaperForecaster& paper) {
  Takes single, several;
  for (const PushTake* take : takes) (take->multi ? several : single).push_back(take);
  std::vector<ForecasterScores> all;
  POISE_RETURN_IF_ERROR(AddSet("single", models, single, context, paper, all));
  POISE_RETURN_IF_ERROR(AddSet("several", models, several, context, paper, all));
  return all;
}

std::string PushScoresCsv(const std::vector<ForecasterScores>& scores) {
  std::string csv = PushScoresHeader();
  for (const ForecasterScores& rows : scores) csv += PushScoresRows(rows.labels, rows.takes);
  return csv;
}

}  // namespace poise::push
