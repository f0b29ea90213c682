#include "core/correction/imitation/imitation_learner.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "core/base/json.h"
#include "core/correction/imitation/imitation_environment.h"
#include "core/correction/imitation/policy_rollout.h"
#include "core/learning/rl/ppo.h"

namespace poise::correction {
namespace {

constexpr int kCheckpointVersion = 1;

Status Malformed(std::string_view what) {
  return base::InvalidArgument("MALFORMED_CHECKPOINT", "checkpoint",
                               fmt::format("the checkpoint of an imitation is damaged: {}", what));
}

base::Json ToJson(const PolicyScore& score) {
  return {score.samples,
          score.variants,
          score.completed,
          score.reward_normalised,
          score.residual_force_mean_bw,
          score.residual_force_peak_bw,
          score.residual_torque_mean_nm,
          score.merit};
}

PolicyScore ScoreFromJson(const base::Json& json) {
  return {.samples = base::IntegerFrom<int64_t>(json.at(0)),
          .variants = base::IntegerFrom<int>(json.at(1)),
          .completed = base::IntegerFrom<int>(json.at(2)),
          .reward_normalised = json.at(3),
          .residual_force_mean_bw = json.at(4),
          .residual_force_peak_bw = json.at(5),
          .residual_torque_mean_nm = json.at(6),
          .merit = json.at(7)};
}

base::Json Bytes(std::string_view bytes) {
  return base::Json::binary({bytes.begin(), bytes.end()});
}

std::string BytesFromJson(const base::Json& json) {
  const auto& bytes = json.get_binary();
  return {bytes.begin(), bytes.end()};
}

}  // namespace

struct ImitationLearner::State {
  Corrector corrector;
  ImitationConfig config;
  std::string fingerprint;  // of all that must be equal for a checkpoint to fit
  ImitationSpaces spaces;
  std::vector<ReferenceMotion> held_out;
  MotionTracker tracker;
  rl::Ppo ppo;
  rl::Policy best_policy;
  TrainingReport report;
  int64_t evaluated = -1;  // iteration of the last evaluation

  StatusOr<PolicyScore> Evaluate(const rl::Policy& policy, const base::RunContext& context);
  Status EvaluateNow(const base::RunContext& context);
  bool Converged() const;
  void Report(const base::RunContext& context, double seconds) const;
};

StatusOr<ImitationLearner> ImitationLearner::Create(const Corrector& corrector,
                                                    VariantSource variants,
                                                    const ImitationConfig& config, uint64_t seed) {
  POISE_RETURN_IF_ERROR(config.Validate());
  std::vector<ReferenceMotion> held_out;
  for (int draw = 0; draw < config.held_out; ++draw) {
    POISE_ASSIGN_OR_RETURN(const motion::Clip clip, variants(draw));
    POISE_ASSIGN_OR_RETURN(ReferenceMotion reference, corrector.Reference(clip));
    held_out.push_back(std::move(reference));
  }
  const double frame_rate = held_out.front().frame_rate();
  std::vector<std::unique_ptr<rl::Environment>> environments;
  for (int i = 0; i < config.environments; ++i) {
    POISE_ASSIGN_OR_RETURN(auto environment,
                           ImitationEnvironment::Create(corrector, variants, frame_rate, config));
    environments.push_back(std::move(environment));
  }
  POISE_ASSIGN_OR_RETURN(rl::Ppo ppo, rl::Ppo::Create(std::move(environments), config.ppo, seed));
  POISE_ASSIGN_OR_RETURN(MotionTracker tracker, corrector.Tracker(frame_rate));
  CorrectionConfig correction = corrector.config();
  ImitationConfig imitation = config;
  const std::string fingerprint = base::Json({base::FieldsToJson(correction.Fields()),
                                              base::FieldsToJson(imitation.Fields()), seed})
                                      .dump();
  rl::Policy start = ppo.policy();
  return ImitationLearner(std::make_unique<State>(State{
      .corrector = corrector,
      .config = config,
      .fingerprint = fingerprint,
      .spaces = ImitationSpaces(corrector.shared_model(), corrector.config().tracking, config),
      .held_out = std::move(held_out),
      .tracker = std::move(tracker),
      .ppo = std::move(ppo),
      .best_policy = std::move(start),
      .report = {}}));
}

ImitationLearner::ImitationLearner(std::unique_ptr<State> state) : state_(std::move(state)) {}
ImitationLearner::ImitationLearner(ImitationLearner&&) noexcept = default;
ImitationLearner& ImitationLearner::operator=(ImitationLearner&&) noexcept = default;
ImitationLearner::~ImitationLearner() = default;

StatusOr<PolicyScore> ImitationLearner::State::Evaluate(const rl::Policy& policy,
                                                        const base::RunContext& context) {
  PolicyScore mean{.samples = ppo.samples(), .variants = static_cast<int>(held_out.size())};
  for (const ReferenceMotion& reference : held_out) {
    const auto recording =
        tracker.Track(reference, context, PolicyCommander(spaces, config, reference, policy));
    if (absl::IsOutOfRange(recording.status())) continue;  // diverged: earns nothing
    POISE_RETURN_IF_ERROR(recording.status());
    const TrackingScore& score = recording->score;
    mean.completed += score.completed;
    mean.reward_normalised += score.reward_normalised / mean.variants;
    mean.residual_force_mean_bw += score.residual_force_mean_bw / mean.variants;
    mean.residual_force_peak_bw += score.residual_force_peak_bw / mean.variants;
    mean.residual_torque_mean_nm += score.residual_torque_mean_nm / mean.variants;
    mean.merit += Merit(score, config) / mean.variants;
  }
  return mean;
}

Status ImitationLearner::State::EvaluateNow(const base::RunContext& context) {
  base::RunContext to_the_end = context;
  to_the_end.deadline = absl::InfiniteFuture();
  const rl::Policy policy = ppo.policy();
  POISE_ASSIGN_OR_RETURN(const PolicyScore score, Evaluate(policy, to_the_end));
  // Learned policies are compared with each other: without learning, Correct has `fast` anyway.
  const bool best_has_learned = report.best > 0;
  if (!best_has_learned || score.merit > report.curve[report.best].merit) {
    report.best = static_cast<int>(report.curve.size());
    best_policy = policy;
  }
  report.curve.push_back(score);
  evaluated = ppo.iterations();
  return absl::OkStatus();
}

// No evaluation of the last `patience` ones was better than all before by least_gain.
bool ImitationLearner::State::Converged() const {
  const int now = static_cast<int>(report.curve.size());
  if (config.patience == 0 || now <= config.patience) return false;
  const auto merit = [](const PolicyScore& a, const PolicyScore& b) { return a.merit < b.merit; };
  const auto split = report.curve.end() - config.patience;
  return std::max_element(split, report.curve.end(), merit)->merit <
         std::max_element(report.curve.begin(), split, merit)->merit + config.least_gain;
}

void ImitationLearner::State::Report(const base::RunContext& context, double seconds) const {
  const PolicyScore& best = report.curve[report.best];
  const auto done = static_cast<double>(ppo.samples());
  const auto all = static_cast<double>(config.max_samples);
  const double eta =
      std::min(config.max_seconds - seconds, seconds * (all - done) / std::max(done, 1.0));
  context.Report({.step = ppo.samples(),
                  .total = config.max_samples,
                  .message = "policy",
                  .metrics = {{"reward", best.reward_normalised},
                              {"force", best.residual_force_mean_bw},
                              {"torque", best.residual_torque_mean_nm},
                              {"completed", static_cast<double>(best.completed) / best.variants},
                              {"samples", done},
                              {"eta_s", std::max(eta, 0.0)}}});
}

StatusOr<TrainingReport> ImitationLearner::Train(const base::RunContext& context,
                                                 const CheckpointSink& checkpoint) {
  State& state = *state_;
  TrainingReport& report = state.report;
  const absl::Time begin = absl::Now();
  const double before = report.seconds;
  const auto seconds = [&] { return before + absl::ToDoubleSeconds(absl::Now() - begin); };
  base::RunContext limited = context;
  limited.deadline = std::min(
      context.deadline, begin + absl::Seconds(std::max(state.config.max_seconds - before, 0.0)));
  report.timed_out = false;
  if (report.curve.empty()) POISE_RETURN_IF_ERROR(state.EvaluateNow(context));
  state.Report(context, before);
  while (!(report.converged = state.Converged()) &&
         state.ppo.samples() < state.config.max_samples) {
    const auto iteration = state.ppo.Iterate(limited);
    if (absl::IsDeadlineExceeded(iteration.status())) {
      report.timed_out = absl::Now() >= context.deadline;
      break;
    }
    POISE_RETURN_IF_ERROR(iteration.status());
    report.seconds = seconds();
    report.samples = state.ppo.samples();
    const bool evaluates = state.ppo.iterations() % state.config.evaluate_every == 0;
    if (evaluates) POISE_RETURN_IF_ERROR(state.EvaluateNow(context));
    // Before the checkpoint, which is named by the progress that it holds.
    state.Report(context, report.seconds);
    if (evaluates && checkpoint) POISE_RETURN_IF_ERROR(checkpoint(Save()));
  }
  if (state.evaluated < state.ppo.iterations()) POISE_RETURN_IF_ERROR(state.EvaluateNow(context));
  report.seconds = seconds();
  return report;
}

StatusOr<Recording> ImitationLearner::Imitate(const ReferenceMotion& reference,
                                              const base::RunContext& context) const {
  POISE_ASSIGN_OR_RETURN(MotionTracker tracker, state_->corrector.Tracker(reference.frame_rate()));
  return tracker.Track(
      reference, context,
      PolicyCommander(state_->spaces, state_->config, reference, state_->best_policy));
}

StatusOr<Correction> ImitationLearner::Correct(const motion::Clip& variant,
                                               const base::RunContext& context) const {
  const Corrector& corrector = state_->corrector;
  POISE_ASSIGN_OR_RETURN(const ReferenceMotion reference, corrector.Reference(variant));
  POISE_ASSIGN_OR_RETURN(MotionTracker tracker, corrector.Tracker(reference.frame_rate()));
  const LearningConfig& learning = corrector.config().learning;
  auto fast = LearnIteratively(tracker, reference, learning, context);
  if (!fast.ok() && !absl::IsOutOfRange(fast.status())) return fast.status();
  auto full = LearnIteratively(
      tracker, reference, learning, context,
      PolicyCommander(state_->spaces, state_->config, reference, state_->best_policy));
  if (absl::IsCancelled(full.status())) return full.status();
  // What diverged is no candidate; where both did, the error is fast's.
  if (!fast.ok() && !full.ok()) return fast.status();
  const bool better = full.ok() && (!fast.ok() || Merit(full->best.score, state_->config) >
                                                      Merit(fast->best.score, state_->config));
  const bool late = absl::IsDeadlineExceeded(full.status());
  Learned learned = better ? *std::move(full) : *std::move(fast);
  POISE_ASSIGN_OR_RETURN(Correction correction, corrector.Assess(variant, reference, learned.best));
  correction.effort = better ? "full" : "fast";
  correction.rollouts = std::move(learned.scores);
  correction.timed_out = learned.timed_out || late;
  return correction;
}

std::string ImitationLearner::Save() const {
  const State& state = *state_;
  base::Json curve = base::Json::array();
  for (const PolicyScore& score : state.report.curve) curve.push_back(ToJson(score));
  const base::Json json = {{"version", kCheckpointVersion},
                           {"fingerprint", state.fingerprint},
                           {"curve", curve},
                           {"best", state.report.best},
                           {"seconds", state.report.seconds},
                           {"evaluated", state.evaluated},
                           {"best_policy", Bytes(state.best_policy.Save())},
                           {"ppo", Bytes(state.ppo.Save())}};
  std::string bytes;
  base::Json::to_cbor(json, bytes);
  return bytes;
}

Status ImitationLearner::Restore(std::string_view checkpoint) {
  State& state = *state_;
  try {
    const base::Json json = base::Json::from_cbor(checkpoint);
    if (json.at("version") != kCheckpointVersion) return Malformed("unknown version");
    if (json.at("fingerprint") != state.fingerprint) {
      return base::FailedPrecondition("CHECKPOINT_DIFFERS", "checkpoint",
                                      "the checkpoint is of another config or seed");
    }
    TrainingReport report;
    for (const base::Json& score : json.at("curve")) report.curve.push_back(ScoreFromJson(score));
    report.best = base::IntegerFrom<int>(json.at("best"));
    report.seconds = json.at("seconds");
    if (report.best < 0 || report.best >= std::max<int>(1, report.curve.size())) {
      return Malformed("no best policy");
    }
    const auto evaluated = base::IntegerFrom<int64_t>(json.at("evaluated"));
    POISE_ASSIGN_OR_RETURN(rl::Policy best,
                           rl::Policy::Load(BytesFromJson(json.at("best_policy"))));
    POISE_RETURN_IF_ERROR(state.ppo.Restore(BytesFromJson(json.at("ppo"))));
    report.samples = state.ppo.samples();
    state.best_policy = std::move(best);
    state.report = std::move(report);
    state.evaluated = evaluated;
    return absl::OkStatus();
  } catch (const base::Json::exception& error) {
    return Malformed(error.what());
  }
}

}  // namespace poise::correction
