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

#include "CLI/CLI.hpp"
#include "core/push/evaluation/evaluate_push.h"
#include "core/push/ldp/forecast_ldp.h"
#include "core/push/takes/fzj_takes.h"

namespace poise {
namespace {

struct Options {
  std::string data, out;
  std::string on = "test";
  std::vector<std::string> models;
  uint64_t seed = 1;
};

void PrintMeans(const push::ScoreLabels& labels, const std::vector<push::TakeScores>& takes,
                const char* note) {
  if (takes.empty()) return;
  const push::Measures mean = push::MeanOverTakes(takes);
  std::printf(
      "%-18s %-1s %-7s%s: MPJPE %.4f hip ADE %.4f FDE %.4f pose %.4f MBLE %.1e FSE %.3f (true "
      "%.3f) toe down %.3f (true %.3f) steps %.2f x true, recall %.2f\n",
      labels.model.c_str(), labels.protocol.c_str(), labels.set.c_str(), note, mean.at("mpjpe"),
      mean.at("hipade"), mean.at("hipfde"), mean.at("pose_only"), mean.at("mble"),
      mean.at("fse_toe_050"), mean.at("true_fse_toe_050"), mean.at("toe_contact"),
      mean.at("true_toe_contact"), mean.at("step_ratio"), mean.at("step_recall"));
}

void Print(const push::ForecasterScores& scores) {
  PrintMeans(scores.labels, scores.takes, "");
  PrintMeans(scores.labels, push::WithoutOutliers(scores.takes), ", no outlier");
  for (const auto& [measure, less] : scores.less_statue) {
    std::printf(
        "    %-6s less the statue's %+.4f, 90 %% of draws %+.4f to %+.4f, lower in %.0f %%\n",
        measure.c_str(), less.mean, less.low, less.high, 100 * less.better_share);
  }
}

Status Run(const Options& options) {
  POISE_ASSIGN_OR_RETURN(const std::vector<push::PushTake> takes, push::ReadTakes(options.data));
  std::vector<artifacts::ModelArtifact> models;
  std::vector<push::NamedModel> named;
  models.reserve(options.models.size());
  for (const std::string& folder : options.models) {
    POISE_ASSIGN_OR_RETURN(artifacts::ModelArtifact model, artifacts::ReadModelFolder(folder));
    models.push_back(std::move(model));
    const std::filesystem::path path(folder);
    named.push_back(
        {path.parent_path().filename().string() + "/" + path.filename().string(), models.back()});
  }
  base::RunContext context;
  context.seed = options.seed;
  POISE_ASSIGN_OR_RETURN(
      const std::vector<push::ForecasterScores> scores,
      push::EvaluatePush(named,
                         options.on == "validation" ? push::SplitTraining(takes).validation
                                                    : push::TakesOf(takes, push::Split::kTest),
                         context, push::ldp::ForecastTakes));
  for (const push::ForecasterScores& rows : scores) Print(rows);
  if (!options.out.empty()) std::ofstream(options.out) << push::PushScoresCsv(scores);
  return absl::OkStatus();
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
