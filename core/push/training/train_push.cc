#include "core/push/training/train_push.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/random.h"
#include "core/base/version.h"
#include "core/learning/nn/module_state.h"
#include "core/push/body_joints.h"
#include "core/push/push_forecaster.h"
#include "core/push/training/hip_training.h"
#include "core/push/training/pose_training.h"

namespace poise::push {
namespace {

constexpr const char* kTrainer = "trainer";  // checkpoint of the member that is being trained

// What has been trained so far; everything of it is in a checkpoint.
struct Ensemble {
  base::TensorFile weights;  // of the members that are done
  int members = 0;           // done, hips first
  int64_t steps = 0;
  double seconds = 0;
  double hip_error = 0, pose_error = 0;  // sums over members
  std::string curve_csv;
};

// The numbers of an ensemble as texts of a tensor file.
std::string Encode(const Ensemble& done, std::string_view trainer) {
  base::TensorFile file = done.weights;
  file.metadata = {{"members", std::to_string(done.members)},
                   {"steps", std::to_string(done.steps)},
                   {"seconds", fmt::format("{}", done.seconds)},
                   {"hip_error", fmt::format("{}", done.hip_error)},
                   {"pose_error", fmt::format("{}", done.pose_error)},
                   {"curve", done.curve_csv}};
  file.tensors[kTrainer] = {.type = base::ElementType::kUint8,
                            .shape = {static_cast<int64_t>(trainer.size())},
                            .bytes = std::string(trainer)};
  return base::EncodeTensors(file);
}

StatusOr<std::pair<Ensemble, std::string>> Decode(const std::string& checkpoint) {
  const auto corrupt = [](const std::string& problem) {
    return base::MakeError(absl::StatusCode::kDataLoss, "CORRUPT_CHECKPOINT", "",
                           "the checkpoint of a push training " + problem);
  };
  StatusOr<base::TensorFile> file = base::DecodeTensors(checkpoint, "checkpoint");
  if (!file.ok()) return corrupt(std::string(base::Message(file.status())));
  const auto trainer = file->tensors.extract(kTrainer);
  if (trainer.empty()) return corrupt("has no trainer");
  Ensemble done;
  try {
    const auto& text = file->metadata;
    done.members = std::stoi(text.at("members"));
    done.steps = std::stoll(text.at("steps"));
    done.seconds = std::stod(text.at("seconds"));
    done.hip_error = std::stod(text.at("hip_error"));
    done.pose_error = std::stod(text.at("pose_error"));
    done.curve_csv = text.at("curve");
  } catch (const std::exception& error) {
    return corrupt(fmt::format("lacks a number: {}", error.what()));
  }
  file->metadata.clear();
  done.weights = *std::move(file);
  return std::pair(std::move(done), trainer.mapped().bytes);
}

/// Trains member after member.
class EnsembleTraining {
 public:
  EnsembleTraining(const PushTask& task, std::vector<const PushTake*> takes, Protocol protocol,
                   const base::RunContext& context, const learning::CheckpointSink& sink)
      : config_(task.config),
        takes_(std::move(takes)),
        protocol_(protocol),
        context_(context),
        sink_(sink) {
    total_ = config_.hip_members * config_.hip_training.network.steps +
             config_.pose_members * config_.pose_training.network.steps;
  }

  StatusOr<Ensemble> Run(Ensemble done, std::optional<std::string> checkpoint) {
    done_ = std::move(done);
    while (done_.members < config_.hip_members + config_.pose_members) {
      const bool hip = done_.members < config_.hip_members;
      const int member = hip ? done_.members : done_.members - config_.hip_members;
      const Resumption resumption{std::exchange(checkpoint, std::nullopt), MemberSink()};
      POISE_RETURN_IF_ERROR(hip ? TrainHipMember(member, resumption)
                                : TrainPoseMember(member, resumption));
      ++done_.members;
    }
    return std::move(done_);
  }

 private:
  learning::CheckpointSink MemberSink() const {
    if (!sink_.save) return {};
    return {sink_.interval, [this](std::string_view bytes, int64_t step) {
              return sink_.save(Encode(done_, bytes), done_.steps + step);
            }};
  }

  base::RunContext MemberContext() const {
    base::RunContext member = context_;
    member.seed = base::DeriveSeed(context_.seed, {static_cast<uint64_t>(done_.members)});
    if (context_.progress) {
      member.progress = [this](const base::Progress& progress) {
        base::Progress whole = progress;
        whole.step += done_.steps;
        whole.total = total_;
        whole.message = fmt::format("member {} of {}", done_.members + 1,
                                    config_.hip_members + config_.pose_members);
        context_.progress(whole);
      };
    }
    return member;
  }

  // Each hip network's validation takes, on which it stands for networks that have not seen them.
  StatusOr<HipForecasts> ForecastHips() const {
    HipForecasts forecasts;
    base::Random random(context_.seed);
    for (int member = 0; member < config_.hip_members; ++member) {
      HipNet net(config_.hip);
      POISE_RETURN_IF_ERROR(
          learning::LoadState(done_.weights, fmt::format("hip{}.", member), *net));
      AddForecasts(net, SplitTakes(takes_, member).validation, protocol_, config_.pose.lookahead,
                   random, forecasts);
    }
    return forecasts;
  }

  void Note(const learning::TrainingReport& report, const std::string& curve,
            const std::string& name) {
    done_.steps += report.steps;
    done_.seconds += report.seconds;
    done_.curve_csv += fmt::format("# {}\n{}", name, curve);
  }

  Status TrainHipMember(int member, const Resumption& resumption) {
    POISE_ASSIGN_OR_RETURN(const TrainedHip trained,
                           TrainHip(SplitTakes(takes_, member), protocol_, config_.hip,
                                    config_.hip_training, MemberContext(), resumption));
    done_.hip_error += trained.report.best_validation;
    Note(trained.report, trained.curve_csv, fmt::format("hip{}", member));
    return learning::AppendState(*trained.net, fmt::format("hip{}.", member), done_.weights);
  }

  Status TrainPoseMember(int member, const Resumption& resumption) {
    if (forecasts_.empty()) {
      POISE_ASSIGN_OR_RETURN(forecasts_, ForecastHips());
    }
    POISE_ASSIGN_OR_RETURN(const TrainedPose trained,
                           TrainPose(SplitTakes(takes_, member), forecasts_, config_.pose,
                                     config_.pose_training, MemberContext(), resumption));
    done_.pose_error += trained.report.best_validation;
    Note(trained.report, trained.curve_csv, fmt::format("pose{}", member));
    return learning::AppendState(*trained.net, fmt::format("pose{}.", member), done_.weights);
  }

  const PushTraining& config_;
  const std::vector<const PushTake*> takes_;
  const Protocol protocol_;
  const base::RunContext& context_;
  const learning::CheckpointSink& sink_;
  int64_t total_ = 0;
  Ensemble done_;
  HipForecasts forecasts_;
};

// The training takes of which the config has the networks learn.
std::vector<const PushTake*> TakesFor(const PushTask& task) {
  std::vector<const PushTake*> all = TakesOf(task.takes, Split::kTrain);
  if (task.config.hold_out) all = SplitTakes(all, 0).train;
  std::vector<const PushTake*> chosen;
  for (size_t i = 0; i < all.size(); i += task.config.every_take) chosen.push_back(all[i]);
  return chosen;
}

}  // namespace

motion::MotionSignature PushSignature() {
  return {.roles = motion::RequiredRoles(),
          .rotation = motion::RotationRepresentation::kQuaternion,
          .with_root_position = true,
          .frame_rate = kFrameRate};
}

StatusOr<PushResult> TrainPush(const PushTask& task, const base::RunContext& context,
                               const std::optional<std::string>& checkpoint,
                               const learning::CheckpointSink& sink) {
  PushTraining config = task.config;
  POISE_RETURN_IF_ERROR(config.Validate());
  POISE_ASSIGN_OR_RETURN(const Protocol protocol, ParseProtocol(config.protocol));
  const std::vector<const PushTake*> takes = TakesFor(task);
  const TrainingTakes split = SplitTakes(takes, 0);
  if (split.train.empty() || split.validation.empty()) {
    return base::InvalidArgument("NO_TAKES", "",
                                 fmt::format("{} training and {} validation takes, both need some",
                                             split.train.size(), split.validation.size()));
  }
  Ensemble done;
  std::optional<std::string> trainer;
  if (checkpoint) {
    POISE_ASSIGN_OR_RETURN(std::tie(done, trainer), Decode(*checkpoint));
  }
  EnsembleTraining training(task, takes, protocol, context, sink);
  POISE_ASSIGN_OR_RETURN(done, training.Run(std::move(done), std::move(trainer)));

  PushResult result;
  result.model.weights = std::move(done.weights);
  result.seconds = done.seconds;
  result.curve_csv = std::move(done.curve_csv);
  api::ModelCard& card = result.model.card;
  card.family = kModelFamily;
  card.preset = task.preset;
  card.config = base::FieldsToJson(config.Fields());
  card.signature = PushSignature();
  card.data = task.data;
  card.data_fingerprint = task.data_fingerprint;
  card.data_license = task.data_license;
  card.trained_on =
      fmt::format("the published training takes of {}, protocol {}", task.data, config.protocol);
  card.seed = context.seed;
  card.steps = done.steps;
  card.program_version = base::Version();
  card.scores = {{"validation_hip_ade_m", done.hip_error / config.hip_members},
                 {"validation_pose_m", done.pose_error / config.pose_members}};
  card.weights_sha256 = artifacts::WeightsDigest(result.model.weights);
  return result;
}

}  // namespace poise::push
