#include "core/pipeline/correct.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/random.h"
#include "core/correction/corrector.h"
#include "core/pipeline/correct_settings.h"

namespace poise::pipeline {
namespace {

using correction::CorrectionConfig;
using correction::Corrector;
using correction::PolicyLearner;
using correction::TrackingScore;

/// Variants to learn from are drawn from a request of their own, so that none is corrected later.
constexpr uint64_t kTrainingStream = 0x7261696e;

CorrectionConfig WithoutLearning(CorrectionConfig config) {
  config.effort = "instant";
  return config;
}

api::CorrectionScore ScoreOf(const TrackingScore& score) {
  return {.residual_force_mean_bw = score.residual_force_mean_bw,
          .residual_force_peak_bw = score.residual_force_peak_bw,
          .residual_torque_mean_nm = score.residual_torque_mean_nm,
          .residual_torque_peak_nm = score.residual_torque_peak_nm,
          .torque_saturation = score.torque_saturation,
          .completion = score.completion,
          .reward_imitation = score.reward_imitation,
          .reward_normalised = score.reward_normalised,
          .reward_total = score.reward_total,
          .pose_error_rad = score.pose_error_rad,
          .pose_error_m = score.pose_error_m};
}

std::vector<api::RewardPoint> CurveOf(const correction::Correction& correction) {
  std::vector<api::RewardPoint> curve;
  const int64_t frames = correction.clip.num_frames();
  for (const TrackingScore& score : correction.rollouts) {
    curve.push_back({.samples = frames * static_cast<int64_t>(curve.size() + 1),
                     .reward_normalised = score.reward_normalised,
                     .residual_force_mean_bw = score.residual_force_mean_bw,
                     .residual_torque_mean_nm = score.residual_torque_mean_nm});
  }
  return curve;
}

std::vector<api::RewardPoint> CurveOf(const correction::TrainingReport& report) {
  std::vector<api::RewardPoint> curve;
  for (const correction::PolicyScore& score : report.curve) {
    curve.push_back({.samples = score.samples,
                     .reward_normalised = score.reward_normalised,
                     .residual_force_mean_bw = score.residual_force_mean_bw,
                     .residual_torque_mean_nm = score.residual_torque_mean_nm});
  }
  return curve;
}

// A source with the characters of its own bone lengths.
struct Source {
  ResolvedSource resolved;
  Corrector corrector;
  Corrector quick;  // without learning
  Corrector zero;
  std::unique_ptr<PolicyLearner> learner = {};  // once Learn made it
};

StatusOr<Source> MakeSource(ResolvedSource resolved, const CorrectionConfig& config,
                            const std::string& debias, const correction::DebiaserPtr& debiaser) {
  const auto create = [&](const CorrectionConfig& wanted, correction::DebiaserPtr with) {
    return Corrector::Create(resolved.clip, resolved.roles, wanted, std::move(with));
  };
  if (debiaser != nullptr) {
    POISE_RETURN_IF_ERROR(debiaser->CheckFits(debias, resolved.clip, resolved.roles));
  }
  POISE_ASSIGN_OR_RETURN(Corrector corrector, create(config, debiaser));
  POISE_ASSIGN_OR_RETURN(Corrector quick, create(WithoutLearning(config), debiaser));
  POISE_ASSIGN_OR_RETURN(Corrector zero, create(ZeroPolicyConfig(config), nullptr));
  return Source{std::move(resolved), std::move(corrector), std::move(quick), std::move(zero)};
}

}  // namespace

class CorrectFlow::Implementation {
 public:
  Implementation(const api::CorrectSpec& spec, uint64_t seed, CorrectSettings settings,
                 std::vector<Source> sources, std::unique_ptr<AugmentFlow> augment,
                 std::unique_ptr<AugmentFlow> training, PolicyLearnerFactory make_learner)
      : method(spec.method),
        seed(seed),
        variants_per_source(spec.Variants()),
        settings(std::move(settings)),
        sources(std::move(sources)),
        augment(std::move(augment)),
        training(std::move(training)),
        make_learner(std::move(make_learner)) {}

  // Of one pass over the motion.
  int rollouts() const {
    return settings.correction.effort == "instant" ? 1 : settings.correction.learning.rollouts;
  }

  StatusOr<api::Variant> Make(int64_t ordinal, const base::RunContext& context) const {
    if (augment != nullptr) return augment->Make(ordinal, context);
    motion::Clip clip = sources[ordinal].resolved.clip;
    return api::Variant{.source_index = static_cast<int>(ordinal),
                        .index = 0,
                        .seed = base::DeriveSeed(seed, {static_cast<uint64_t>(ordinal), 0}),
                        .clip = std::move(clip),
                        .ik = std::nullopt,
                        .plausibility = std::nullopt};
  }

  // The best until the deadline; at least one rollout while last_call allows.
  static StatusOr<correction::Correction> Try(const Source& source, const motion::Clip& clip,
                                              const base::RunContext& context,
                                              absl::Time last_call) {
    auto correction = source.learner ? source.learner->Correct(clip, context)
                                     : source.corrector.Correct(clip, context);
    if (!absl::IsDeadlineExceeded(correction.status())) return correction;
    base::RunContext rest = context;
    rest.deadline = last_call;
    correction = source.quick.Correct(clip, rest);
    if (correction.ok()) correction->timed_out = true;
    return correction;
  }

  correction::VariantSource TrainingVariants(int source) const {
    if (training == nullptr) {
      return [this, source](uint64_t) { return sources[source].resolved.clip; };
    }
    return [this, source](uint64_t draw) -> StatusOr<motion::Clip> {
      const int64_t per_source = training->num_variants() / static_cast<int64_t>(sources.size());
      const int64_t ordinal = source * per_source + static_cast<int64_t>(draw % per_source);
      POISE_ASSIGN_OR_RETURN(api::Variant variant, training->Make(ordinal, {}));
      return std::move(variant.clip);
    };
  }

  // The learner of a source as its checkpoint left it.
  StatusOr<PolicyLearner*> Learner(int source, const LearnedPolicy& policy) {
    std::unique_ptr<PolicyLearner>& learner = sources[source].learner;
    const uint64_t own_seed =
        base::DeriveSeed(seed, {kTrainingStream, static_cast<uint64_t>(source)});
    POISE_ASSIGN_OR_RETURN(learner,
                           make_learner(sources[source].corrector, TrainingVariants(source),
                                        settings.imitation, own_seed));
    if (!policy.checkpoint.empty()) POISE_RETURN_IF_ERROR(learner->Restore(policy.checkpoint));
    return learner.get();
  }

  const std::string method;
  const uint64_t seed;
  const int variants_per_source;
  const CorrectSettings settings;
  std::vector<Source> sources;
  const std::unique_ptr<AugmentFlow> augment;   // none for the method none
  const std::unique_ptr<AugmentFlow> training;  // for effort full; none for the method none
  const PolicyLearnerFactory make_learner;
};

CorrectFlow::CorrectFlow(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
CorrectFlow::~CorrectFlow() = default;

StatusOr<std::unique_ptr<CorrectFlow>> CorrectFlow::Create(const api::CorrectSpec& spec,
                                                           uint64_t seed,
                                                           std::vector<ResolvedSource> sources,
                                                           CorrectNetworks networks) {
  POISE_RETURN_IF_ERROR(CheckCorrect(spec));
  POISE_ASSIGN_OR_RETURN(CorrectSettings settings, CorrectSettings::From(spec));
  if (settings.learns && !networks.make_learner) {
    return base::FailedPrecondition("NO_NETWORKS", "effort", "this program learns no policies");
  }
  std::unique_ptr<AugmentFlow> augment, training;
  if (spec.method != kNoMethod) {
    POISE_ASSIGN_OR_RETURN(
        augment, AugmentFlow::Create(AugmentSpecOf(spec, seed), sources, networks.decoder));
  }
  if (augment != nullptr && settings.learns) {
    api::AugmentSpec draws = AugmentSpecOf(spec, base::DeriveSeed(seed, {kTrainingStream}));
    draws.variants_per_source = api::AugmentSpec::kMaxVariants;
    POISE_ASSIGN_OR_RETURN(training, AugmentFlow::Create(draws, sources, networks.decoder));
  }
  std::vector<Source> made;
  for (ResolvedSource& source : sources) {
    const std::string field = fmt::format("sources[{}]", made.size());
    const std::string clip = fmt::format("clip '{}'", source.clip.name());
    StatusOr<Source> one =
        MakeSource(std::move(source), settings.correction, spec.debias, networks.debiaser);
    if (!one.ok()) return base::Annotate(one.status(), clip, field);
    made.push_back(*std::move(one));
  }
  return std::unique_ptr<CorrectFlow>(new CorrectFlow(std::make_unique<Implementation>(
      spec, seed, std::move(settings), std::move(made), std::move(augment), std::move(training),
      std::move(networks.make_learner))));
}

int CorrectFlow::num_sources() const { return static_cast<int>(implementation_->sources.size()); }
int CorrectFlow::variants_per_source() const { return implementation_->variants_per_source; }
bool CorrectFlow::learns() const { return implementation_->settings.learns; }

int64_t CorrectFlow::num_variants() const {
  return int64_t{num_sources()} * implementation_->variants_per_source;
}

int64_t CorrectFlow::frames(int source) const {
  return implementation_->sources[source].resolved.clip.num_frames();
}

int64_t CorrectFlow::samples_per_variant(int source) const {
  // A policy's corrections are held against those without it.
  return frames(source) * implementation_->rollouts() * (learns() ? 2 : 1);
}

int64_t CorrectFlow::max_training_samples() const {
  return learns() ? implementation_->settings.imitation.max_samples : 0;
}

const std::string& CorrectFlow::source_name(int source) const {
  return implementation_->sources[source].resolved.clip.name();
}

StatusOr<api::ZeroPolicyReport> CorrectFlow::ZeroPolicy(int source,
                                                        const base::RunContext& context) const {
  const Source& from = implementation_->sources[source];
  POISE_ASSIGN_OR_RETURN(const correction::Correction correction,
                         from.zero.Correct(from.resolved.clip, context));
  return api::ZeroPolicyReport{.completed = correction.score.completed,
                               .measures = {correction.after, ScoreOf(correction.score)}};
}

Status CorrectFlow::Learn(int source, const base::RunContext& context,
                          const std::function<Status(const LearnedPolicy&)>& save,
                          LearnedPolicy& policy) {
  POISE_ASSIGN_OR_RETURN(PolicyLearner* const learner, implementation_->Learner(source, policy));
  if (policy.finished) return absl::OkStatus();
  POISE_ASSIGN_OR_RETURN(const correction::TrainingReport report,
                         learner->Train(context, [&](std::string checkpoint) {
                           policy.checkpoint = std::move(checkpoint);
                           return save(policy);
                         }));
  POISE_RETURN_IF_ERROR(context.Check());
  policy.checkpoint = learner->Save();
  policy.finished = true;
  policy.curve = CurveOf(report);
  policy.samples = report.samples;
  policy.stopped_by = report.converged                           ? "converged"
                      : report.samples >= max_training_samples() ? "max_samples"
                                                                 : "max_seconds";
  return save(policy);
}

StatusOr<CorrectedVariant> CorrectFlow::Correct(int64_t ordinal, const base::RunContext& context,
                                                absl::Time last_call) const {
  // Making a variant takes milliseconds and is not what the time is for.
  base::RunContext making = context;
  making.deadline = absl::InfiniteFuture();
  POISE_ASSIGN_OR_RETURN(api::Variant variant, implementation_->Make(ordinal, making));
  const Source& source = implementation_->sources[variant.source_index];
  CorrectedVariant result;
  result.source_index = variant.source_index;
  result.report.index = variant.index;
  result.report.seed = variant.seed;
  auto correction = Implementation::Try(source, variant.clip, context, last_call);
  if (correction.ok()) {
    result.report.completed = correction->score.completed;
    result.report.effort = correction->effort;
    result.report.before = correction->before;
    result.report.after = {correction->after, ScoreOf(correction->score)};
    result.curve = CurveOf(*correction);
    result.samples = result.curve.back().samples;
    result.timed_out = correction->timed_out;
    result.clip = std::move(correction->clip);
    result.clip->set_name(fmt::format("{}_{}_{}", source.resolved.clip.name(),
                                      implementation_->method, variant.index));
    return result;
  }
  Status why = correction.status();
  result.timed_out = absl::IsDeadlineExceeded(why);
  if (result.timed_out) {
    why = base::MakeError(absl::StatusCode::kDeadlineExceeded, "OUT_OF_TIME", "max_seconds",
                          "the time was up before this variant was imitated once");
  } else if (base::ErrorReason(why) != "DIVERGED") {
    return base::Annotate(
        why, fmt::format("variant {} of source {}", variant.index, variant.source_index));
  }
  result.report.error = api::JobError::From(why);
  POISE_ASSIGN_OR_RETURN(const auto reference, source.corrector.Reference(variant.clip));
  POISE_ASSIGN_OR_RETURN(result.report.before, source.corrector.AssessReference(reference));
  return result;
}

}  // namespace poise::pipeline
