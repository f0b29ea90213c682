#include "core/push/ldp/train_ldp.h"

#include <fmt/format.h>

#include <functional>
#include <utility>

#include "core/base/random.h"
#include "core/base/version.h"
#include "core/learning/nn/guard.h"
#include "core/learning/nn/module_state.h"
#include "core/push/ldp/ldp_tasks.h"

namespace poise::push::ldp {
namespace {

constexpr const char* kTrainer = "trainer";  // checkpoint of the stage that is being trained
constexpr const char* kWeights = "net.";

// What has been trained so far; with the weights everything that a checkpoint needs.
struct Done {
  int stages = 0;
  int64_t steps = 0;
  double seconds = 0;
  base::Json scores = base::Json::object();
  std::string curve_csv;
};

StatusOr<std::string> Encode(const Done& done, const LdpNet& net, std::string_view trainer) {
  base::TensorFile file;
  POISE_RETURN_IF_ERROR(learning::AppendState(*net, kWeights, file));
  file.metadata = {{"stages", std::to_string(done.stages)},
                   {"steps", std::to_string(done.steps)},
                   {"seconds", fmt::format("{}", done.seconds)},
                   {"scores", done.scores.dump()},
                   {"curve", done.curve_csv}};
  file.tensors[kTrainer] = {.type = base::ElementType::kUint8,
                            .shape = {static_cast<int64_t>(trainer.size())},
                            .bytes = std::string(trainer)};
  return base::EncodeTensors(file);
}

// Fills `net`; returns what was done and the checkpoint of the stage under way, if it has begun.
StatusOr<std::pair<Done, std::optional<std::string>>> Decode(const std::string& checkpoint,
                                                             LdpNet& net) {
  const auto corrupt = [](std::string_view problem) {
    return base::MakeError(absl::StatusCode::kDataLoss, "CORRUPT_CHECKPOINT", "",
                           fmt::format("the checkpoint of a push training: {}", problem));
  };
  StatusOr<base::TensorFile> file = base::DecodeTensors(checkpoint, "checkpoint");
  if (!file.ok()) return corrupt(base::Message(file.status()));
  const auto trainer = file->tensors.extract(kTrainer);
  if (trainer.empty()) return corrupt("it has no trainer");
  const Status loaded = learning::LoadState(*file, kWeights, *net);
  if (!loaded.ok()) return corrupt(base::Message(loaded));
  Done done;
  try {
    const auto& text = file->metadata;
    done.stages = std::stoi(text.at("stages"));
    done.steps = std::stoll(text.at("steps"));
    done.seconds = std::stod(text.at("seconds"));
    done.scores = base::Json::parse(text.at("scores"));
    done.curve_csv = text.at("curve");
  } catch (const std::exception& error) {
    return corrupt(error.what());
  }
  std::optional<std::string> begun;
  if (!trainer.mapped().bytes.empty()) begun = trainer.mapped().bytes;
  return std::pair(std::move(done), std::move(begun));
}

using Stage = std::function<NetworkTask()>;

// The paper's order.
std::vector<Stage> StagesOf(const LdpTraining& config, LdpNet net,
                            std::shared_ptr<const LdpTakes> takes) {
  std::vector<Stage> stages;
  if (config.pendulum) {
    stages.push_back([=] { return BalanceTask(net, takes, config); });
    if (!takes->several.train.empty()) {
      stages.push_back([=] { return InteractionTask(net, takes, config); });
    }
  }
  const auto samples = std::make_shared<const BodySamples>(net, *takes);
  for (size_t part = 0; part < net->body->num_parts(); ++part) {
    stages.push_back([=] { return CvaeTask(net, part, samples, config.cvae_training); });
    if (config.pendulum) {
      stages.push_back([=] { return SamplerTask(net, part, samples, config.sampler_training); });
    }
  }
  for (int round = 0; config.pendulum && round < config.end_to_end.rounds; ++round) {
    stages.push_back([=] { return EndToEndTask(net, takes, config); });
  }
  return stages;
}

int64_t StepsOf(const LdpTraining& config, const LdpNet& net, bool several) {
  const auto parts = static_cast<int64_t>(net->body->num_parts());
  int64_t steps = parts * config.cvae_training.network.steps;
  if (!config.pendulum) return steps;
  steps += parts * config.sampler_training.network.steps + config.balance_training.network.steps;
  if (several) steps += config.interaction_training.network.steps;
  return steps + config.end_to_end.rounds * config.end_to_end.network.steps;
}

Status TrainStages(const std::vector<Stage>& stages, LdpNet& net, Done& done,
                   std::optional<std::string> trainer, int64_t total,
                   const base::RunContext& context, const learning::CheckpointSink& sink) {
  while (done.stages < static_cast<int>(stages.size())) {
    NetworkTask task = stages[done.stages]();
    const std::string name = task.name;
    base::RunContext own = context;
    own.seed = base::DeriveSeed(context.seed, {static_cast<uint64_t>(done.stages)});
    if (context.progress) {
      own.progress = [&](const base::Progress& progress) {
        base::Progress whole = progress;
        whole.step += done.steps;
        whole.total = total;
        whole.message = name;
        context.progress(whole);
      };
    }
    Resumption resumption{std::exchange(trainer, std::nullopt), {}};
    if (sink.save) {
      resumption.sink = {sink.interval, [&](std::string_view bytes, int64_t step) -> Status {
                           POISE_ASSIGN_OR_RETURN(const std::string all, Encode(done, net, bytes));
                           return sink.save(all, done.steps + step);
                         }};
    }
    std::string curve;
    POISE_ASSIGN_OR_RETURN(const learning::TrainingReport report,
                           TrainNetwork(std::move(task), own, resumption, &curve));
    ++done.stages;
    done.steps += report.steps;
    done.seconds += report.seconds;
    done.scores[name] = report.best_validation;
    done.curve_csv += fmt::format("# {}\n{}", name, curve);
    if (sink.save) {
      POISE_ASSIGN_OR_RETURN(const std::string all, Encode(done, net, ""));
      POISE_RETURN_IF_ERROR(sink.save(all, done.steps));
    }
  }
  return absl::OkStatus();
}

StatusOr<api::ModelCard> CardOf(const LdpTask& task, LdpTraining& config, LdpNet net,
                                const LdpTakes& takes, const Done& done, uint64_t seed) {
  api::ModelCard card;
  card.family = kFamily;
  card.preset = kPreset;
  card.config = base::FieldsToJson(config.Fields());
  card.signature = PushSignature();
  card.data = task.data;
  card.data_fingerprint = task.data_fingerprint;
  card.data_license = task.data_license;
  card.trained_on =
      fmt::format("the published training takes of {}, protocol {}", task.data, config.protocol);
  card.seed = seed;
  card.steps = done.steps;
  card.program_version = base::Version();
  POISE_ASSIGN_OR_RETURN(const Protocol protocol, ParseProtocol(config.protocol));
  for (const auto& [name, score] : done.scores.items()) card.scores[name] = score.get<double>();
  const auto add = [&](const char* set, const TrainingTakes& of) {
    if (of.validation.empty()) return;
    card.scores[fmt::format("validation_{}_mpjpe_m", set)] =
        JointErrorOn(net, of.validation, protocol);
  };
  add("single", takes.single);
  add("several", takes.several);
  return card;
}

StatusOr<PushResult> Train(const LdpTask& task, const base::RunContext& context,
                           const std::optional<std::string>& checkpoint,
                           const learning::CheckpointSink& sink) {
  LdpTraining config = task.config;
  POISE_RETURN_IF_ERROR(config.Validate());
  const auto takes = std::make_shared<const LdpTakes>(SplitTraining(task.takes));
  if (takes->single.train.empty() || takes->single.validation.empty()) {
    return base::InvalidArgument("NO_TAKES", "",
                                 "training needs takes of single people, some of them to validate");
  }
  learning::SeedTorch(context.seed);
  LdpNet net(config);
  const std::vector<Stage> stages = StagesOf(config, net, takes);
  Done done;
  std::optional<std::string> trainer;
  if (checkpoint) {
    POISE_ASSIGN_OR_RETURN(std::tie(done, trainer), Decode(*checkpoint, net));
  }
  POISE_RETURN_IF_ERROR(TrainStages(stages, net, done, std::move(trainer),
                                    StepsOf(config, net, !takes->several.train.empty()), context,
                                    sink));
  PushResult result;
  result.seconds = done.seconds;
  result.curve_csv = done.curve_csv;
  POISE_RETURN_IF_ERROR(learning::AppendState(*net, "", result.model.weights));
  POISE_ASSIGN_OR_RETURN(result.model.card, CardOf(task, config, net, *takes, done, context.seed));
  result.model.card.weights_sha256 = artifacts::WeightsDigest(result.model.weights);
  return result;
}

}  // namespace

StatusOr<PushResult> TrainLdp(const LdpTask& task, const base::RunContext& context,
                              const std::optional<std::string>& checkpoint,
                              const learning::CheckpointSink& sink) {
  return learning::Guard("train the push model",
                         [&] { return Train(task, context, checkpoint, sink); });
}

}  // namespace poise::push::ldp
