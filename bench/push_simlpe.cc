// siMLPe as the paper of the push models adapted it (its supplementary, table 6): 12 recorded
// frames say the next 6, again and again to the end of the take. A peer that sees the push only
// through the motion that it has caused; its scores are of the frames after those that it is given.
//
//   push_simlpe --data DIR/fzj_push --set single --seed 1 --out r.csv
//
// Ours, since the paper does not say: coordinates count from the pelvis of the last frame seen, on
// the floor; AdamW along a cosine; the step is chosen on the validation takes.
#include <fmt/format.h>
#include <torch/torch.h>

#include <cstdio>
#include <fstream>

#include "CLI/CLI.hpp"
#include "core/prediction/simlpe/simlpe_net.h"
#include "core/push/evaluation/forecast_take.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/training/train_network.h"

namespace poise {
namespace {

using push::PushTake;
using push::TakePerson;
using torch::Tensor;

constexpr int kCoordinates = 3 * push::kBodyJoints;

struct Options {
  std::string data, out;
  std::string set = "single";
  uint64_t seed = 1;
  int64_t steps = 3000;
};

// (frames, kCoordinates) [m].
Tensor Recorded(const TakePerson& person) {
  Tensor rows = torch::zeros({person.frames(), kCoordinates});
  auto values = rows.accessor<float, 2>();
  for (int frame = 0; frame < person.frames(); ++frame) {
    for (int i = 0; i < kCoordinates; ++i) {
      values[frame][i] = static_cast<float>(person.joint(frame, i / 3)[i % 3]);
    }
  }
  return rows;
}

// The pelvis of frame `frame` on the floor, for every joint: (..., 1, kCoordinates).
Tensor Origin(const Tensor& rows, int frame) {
  const Tensor last = rows.slice(-2, frame, frame + 1);
  const Tensor place =
      torch::cat({last.slice(-1, 0, 2), torch::zeros_like(last.slice(-1, 0, 1))}, -1);
  return torch::cat(std::vector<Tensor>(push::kBodyJoints, place), -1);
}

class Peer {
 public:
  explicit Peer(const prediction::SimlpeConfig& config)
      : config_(config),
        net_(std::make_shared<prediction::SimlpeNet>(config, prediction::NetworkBody{},
                                                     AllColumns())) {}

  std::shared_ptr<torch::nn::Module> module() const { return net_; }
  int window() const { return config_.past_frames + config_.future_frames; }

  // `windows` (windows, past + future, kCoordinates).
  Tensor Loss(const Tensor& windows) {
    const Tensor placed = windows - Origin(windows, config_.past_frames - 1);
    const Tensor target = placed.slice(1, config_.past_frames);
    const Tensor answer = net_->Forward(placed.slice(1, 0, config_.past_frames));
    const auto change = [](const Tensor& rows) { return rows.slice(1, 1) - rows.slice(1, 0, -1); };
    return Distance(answer, target) + Distance(change(answer), change(target));
  }

  // The recorded frames at first, then what the network says: (frames, kCoordinates).
  Tensor Forecast(const Tensor& recorded) {
    const torch::NoGradGuard no_gradient;
    Tensor rows = recorded.slice(0, 0, config_.past_frames);
    while (rows.size(0) < recorded.size(0)) {
      const Tensor past = rows.slice(0, rows.size(0) - config_.past_frames).unsqueeze(0);
      const Tensor origin = Origin(past, config_.past_frames - 1);
      rows = torch::cat({rows, (net_->Forward(past - origin) + origin)[0]});
    }
    return rows.slice(0, 0, recorded.size(0));
  }

  static Tensor Distance(const Tensor& a, const Tensor& b) {
    const Tensor joints = (a - b).reshape({-1, 3});
    return (joints.square().sum(-1) + 1e-12).sqrt().mean();
  }

 private:
  // Every coordinate of every joint is a column.
  static prediction::EulerMeasure AllColumns() {
    prediction::EulerMeasure measure;
    measure.counts = torch::ones({kCoordinates});
    return measure;
  }

  const prediction::SimlpeConfig config_;
  std::shared_ptr<prediction::SimlpeNet> net_;
};

std::vector<push::TakeScores> Scores(Peer& peer, const std::vector<const PushTake*>& takes,
                                     int first_frame) {
  std::vector<push::TakeScores> scores;
  for (const PushTake* take : takes) {
    push::ForecastJoints forecast;
    for (const TakePerson& person : take->people) {
      const Tensor rows = peer.Forecast(Recorded(person)).contiguous();
      const auto values = rows.accessor<float, 2>();
      auto& joints = forecast.emplace_back();
      for (int frame = 0; frame < take->frames; ++frame) {
        for (int i = 0; i < kCoordinates; i += 3) {
          joints.emplace_back(values[frame][i], values[frame][i + 1], values[frame][i + 2]);
        }
      }
    }
    scores.push_back(push::ScoreTake(*take, forecast, first_frame));
  }
  return scores;
}

void Print(const char* what, const std::vector<push::TakeScores>& takes) {
  const push::Measures mean = push::MeanOverTakes(takes);
  std::printf("%s: MPJPE %.4f hip ADE %.4f FDE %.4f MBLE %.4f FSE %.3f (true %.3f)\n", what,
              mean.at("mpjpe"), mean.at("hipade"), mean.at("hipfde"), mean.at("mble"),
              mean.at("fse_toe_050"), mean.at("true_fse_toe_050"));
}

Status Run(const Options& options) {
  const bool single = options.set == "single";
  POISE_ASSIGN_OR_RETURN(
      const std::vector<PushTake> takes,
      single ? push::ReadSingleTakes(options.data) : push::ReadMultiTakes(options.data));
  const push::TrainingTakes split = push::SplitTraining(takes);
  const prediction::SimlpeConfig config{.past_frames = 12, .future_frames = 6};
  learning::SeedTorch(options.seed);
  Peer peer(config);
  std::vector<Tensor> windows;
  for (const PushTake* take : split.train) {
    for (const TakePerson& person : take->people) {
      const Tensor rows = Recorded(person);
      for (int64_t first = 0; first + peer.window() <= rows.size(0); ++first) {
        windows.push_back(rows.slice(0, first, first + peer.window()));
      }
    }
  }
  push::NetworkTask task{
      .name = "simlpe",
      .module = peer.module(),
      .config = {.steps = options.steps,
                 .batch_size = 256,
                 .learning_rate = 1e-3,
                 .weight_decay = 1e-4,
                 .validate_every = 100},
      .num_samples = static_cast<int64_t>(windows.size()),
      .loss = [&](const learning::Batch& step) -> StatusOr<learning::Loss> {
        std::vector<Tensor> chosen;
        for (const int64_t sample : step.samples) chosen.push_back(windows[sample]);
        return learning::Loss{.total = peer.Loss(torch::stack(chosen))};
      },
      .validate = [&]() -> StatusOr<double> {
        return push::MeanOverTakes(Scores(peer, split.validation, config.past_frames)).at("mpjpe");
      }};
  base::RunContext context;
  context.seed = options.seed;
  POISE_ASSIGN_OR_RETURN(const learning::TrainingReport report,
                         push::TrainNetwork(std::move(task), context, {}));
  std::printf("trained %ld steps in %.0f s, best after %ld: validation MPJPE %.4f\n",
              static_cast<long>(report.steps), report.seconds, static_cast<long>(report.best_step),
              report.best_validation);
  const auto scores = Scores(peer, push::TakesOf(takes, push::Split::kTest), config.past_frames);
  Print("all", scores);
  Print("without outliers", push::WithoutOutliers(scores));
  if (!options.out.empty()) {
    std::ofstream(options.out) << push::PushScoresHeader()
                               << push::PushScoresRows(
                                      {"simlpe_12_6", "motion", options.set, options.seed}, scores);
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace poise

int main(int argc, char** argv) {
  poise::Options options;
  CLI::App app("Trains siMLPe on recorded pushes and scores it.");
  app.add_option("--data", options.data, "Folder of FZJ Push")->required();
  app.add_option("--set", options.set)->check(CLI::IsMember({"single", "several"}));
  app.add_option("--seed", options.seed);
  app.add_option("--steps", options.steps, "Of the optimiser");
  app.add_option("--out", options.out, "Results file (CSV)");
  CLI11_PARSE(app, argc, argv);
  const poise::Status status = poise::Run(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
