// Scores push models on recorded takes beside what needs no learning:
//
//   push_evaluation --data DIR/fzj_push --model models/push-fzj/1 --out r.csv
//   push_evaluation --data DIR/fzj_push --model /tmp/a --on validation
//
// A model is told of a push what its card says (protocol). Several --model are several rows.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "CLI/CLI.hpp"
#include "core/artifacts/model_artifact.h"
#include "core/push/evaluation/anchors.h"
#include "core/push/evaluation/forecast_take.h"
#include "core/push/takes/fzj_takes.h"

namespace poise {
namespace {

struct Options {
  std::string data, out;
  std::string on = "test";
  std::vector<std::string> models;
  uint64_t seed = 1;
};

using Takes = std::vector<const push::PushTake*>;
using Scores = std::vector<push::TakeScores>;

class Results {
 public:
  explicit Results(const Options& options) : seed_(options.seed) {}

  void Add(const push::ScoreLabels& labels, const Scores& scores, const Scores* statue) {
    rows_ += push::PushScoresRows(labels, scores);
    Print(labels, scores, "");
    Print(labels, push::WithoutOutliers(scores), ", no outlier");
    if (statue == nullptr) return;
    for (const char* measure : {"mpjpe", "hipade", "hipfde"}) {
      const auto difference = push::Compare(scores, *statue, measure, seed_);
      std::printf(
          "    %-8s less statue's: %+.4f (90 %% of draws %+.4f .. %+.4f), lower in %.0f %%\n",
          measure, difference.mean, difference.low, difference.high, 100 * difference.better_share);
    }
  }

  Status Write(const std::string& path) const {
    if (!path.empty()) std::ofstream(path) << push::PushScoresHeader() << rows_;
    return absl::OkStatus();
  }

 private:
  static void Print(const push::ScoreLabels& labels, const Scores& scores, const char* note) {
    const push::Measures mean = push::MeanOverTakes(scores);
    std::printf(
        "%-28s %s %-7s%s: MPJPE %.4f hip ADE %.4f FDE %.4f pose %.4f MBLE %.1e FSE %.3f (true "
        "%.3f) "
        "toe down %.3f (true %.3f) steps %.2f x true, recall %.2f\n",
        labels.model.c_str(), labels.protocol.c_str(), labels.set.c_str(), note, mean.at("mpjpe"),
        mean.at("hipade"), mean.at("hipfde"), mean.at("pose_only"), mean.at("mble"),
        mean.at("fse_toe_050"), mean.at("true_fse_toe_050"), mean.at("toe_contact"),
        mean.at("true_toe_contact"), mean.at("step_ratio"), mean.at("step_recall"));
    std::fflush(stdout);
  }

  uint64_t seed_;
  std::string rows_;
};

template <typename Forecast>
Scores ScoresOf(const Takes& takes, const Forecast& forecast) {
  Scores scores;
  for (const push::PushTake* take : takes) scores.push_back(ScoreTake(*take, forecast(*take)));
  return scores;
}

Status Evaluate(const Options& options, const std::string& set,
                const std::vector<push::PushTake>& all, Results& results) {
  const Takes takes = options.on == "validation" ? push::SplitTraining(all).validation
                                                 : push::TakesOf(all, push::Split::kTest);
  base::RunContext context;
  context.seed = options.seed;
  results.Add({"nobody moves", "-", set, 0}, ScoresOf(takes, push::NobodyMoves), nullptr);
  results.Add({"statue, true hip", "-", set, 0}, ScoresOf(takes, push::StatueOnTrueHip), nullptr);
  POISE_ASSIGN_OR_RETURN(const auto statue, push::MakeStatueForecaster({}));
  for (const std::string& folder : options.models) {
    POISE_ASSIGN_OR_RETURN(const artifacts::ModelArtifact model,
                           artifacts::ReadModelFolder(folder));
    const std::string protocol = model.card.config.value("protocol", "B");
    POISE_ASSIGN_OR_RETURN(const push::Protocol parsed, push::ParseProtocol(protocol));
    POISE_ASSIGN_OR_RETURN(const Scores still,
                           push::EvaluateForecaster(*statue, takes, parsed, context));
    if (folder == options.models.front()) {
      results.Add({"statue", protocol, set, 0}, still, nullptr);
    }
    POISE_ASSIGN_OR_RETURN(const auto learned, push::MakeLearnedForecaster(model));
    POISE_ASSIGN_OR_RETURN(const Scores scores,
                           push::EvaluateForecaster(*learned, takes, parsed, context));
    results.Add({std::filesystem::path(folder).filename().string(), protocol, set, model.card.seed},
                scores, &still);
  }
  return absl::OkStatus();
}

Status Run(const Options& options) {
  Results results(options);
  POISE_ASSIGN_OR_RETURN(const auto single, push::ReadSingleTakes(options.data));
  POISE_RETURN_IF_ERROR(Evaluate(options, "single", single, results));
  POISE_ASSIGN_OR_RETURN(const auto several, push::ReadMultiTakes(options.data));
  POISE_RETURN_IF_ERROR(Evaluate(options, "several", several, results));
  return results.Write(options.out);
}

}  // namespace
}  // namespace poise

int main(int argc, char** argv) {
  poise::Options options;
  CLI::App app("Scores push models on recorded takes.");
  app.add_option("--data", options.data, "Folder of FZJ Push")->required();
  app.add_option("--model", options.models, "Folder of a trained model; repeatable")
      ->allow_extra_args(false);
  app.add_option("--on", options.on, "Which takes")->check(CLI::IsMember({"test", "validation"}));
  app.add_option("--seed", options.seed, "Of noise and bootstrap");
  app.add_option("--out", options.out, "Results file (CSV)");
  CLI11_PARSE(app, argc, argv);
  const poise::Status status = poise::Run(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
