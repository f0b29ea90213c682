#include "core/pipeline/correct.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/random.h"
#include "core/correction/corrector.h"
#include "core/synthesis/synthesizer_registry.h"

namespace poise::pipeline {
namespace {

using correction::CorrectionConfig;
using correction::Corrector;
using correction::TrackingScore;

constexpr char kNoMethod[] = "none";

// Whether the key is of a step of the method: "ik.radius_low" of "ik+timewarp".
bool IsOfMethod(const std::string& key, const std::string& method) {
  const std::string step = key.substr(0, key.find('.'));
  return ("+" + method + "+").find("+" + step + "+") != std::string::npos;
}

base::Overrides OverridesOf(const api::CorrectSpec& spec, bool of_method) {
  base::Overrides overrides;
  for (const auto& [key, value] : spec.overrides) {
    if (IsOfMethod(key, spec.method) == of_method) overrides[key] = value;
  }
  return overrides;
}

api::AugmentSpec AugmentSpecOf(const api::CorrectSpec& spec, uint64_t seed) {
  api::AugmentSpec augment;
  augment.sources = spec.sources;
  augment.method = spec.method;
  augment.action_class = spec.action_class;
  augment.preset = spec.preset;
  augment.variants_per_source = spec.Variants();
  augment.seed = seed;
  augment.overrides = OverridesOf(spec, /*of_method=*/true);
  augment.with_plausibility = false;  // the corrector measures, by the character's own bodies
  return augment;
}

StatusOr<CorrectionConfig> ConfigOf(const api::CorrectSpec& spec) {
  if (spec.effort == "full") {
    return base::FailedPrecondition(
        "EFFORT_NOT_AVAILABLE", "effort",
        "effort full learns a policy, which this version cannot do yet: use fast or instant");
  }
  POISE_ASSIGN_OR_RETURN(CorrectionConfig config, CorrectionConfig::FromPreset(spec.preset));
  config.effort = spec.effort;
  if (spec.body_mass_kg > 0) config.humanoid.body_mass_kg = spec.body_mass_kg;
  if (spec.residual == "none") config.tracking.residual_factor = 0;
  POISE_RETURN_IF_ERROR(
      base::ApplyOverrides(OverridesOf(spec, /*of_method=*/false), config.Fields()));
  return config;
}

CorrectionConfig ZeroPolicyConfig(const CorrectionConfig& config) {
  CorrectionConfig zero = *CorrectionConfig::FromPreset("paper");
  zero.effort = "instant";
  zero.humanoid.body_mass_kg = config.humanoid.body_mass_kg;
  return zero;
}

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

// A source with the characters of its own bone lengths.
struct Source {
  ResolvedSource resolved;
  Corrector corrector;
  Corrector quick;  // without learning
  Corrector zero;
};

StatusOr<Source> MakeSource(ResolvedSource resolved, const CorrectionConfig& config) {
  const auto create = [&](const CorrectionConfig& wanted) {
    return Corrector::Create(resolved.clip, resolved.roles, wanted);
  };
  POISE_ASSIGN_OR_RETURN(Corrector corrector, create(config));
  POISE_ASSIGN_OR_RETURN(Corrector quick, create(WithoutLearning(config)));
  POISE_ASSIGN_OR_RETURN(Corrector zero, create(ZeroPolicyConfig(config)));
  return Source{std::move(resolved), std::move(corrector), std::move(quick), std::move(zero)};
}

}  // namespace

Status CheckCorrect(const api::CorrectSpec& spec) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  POISE_ASSIGN_OR_RETURN(CorrectionConfig config, ConfigOf(spec));
  POISE_RETURN_IF_ERROR(base::CheckRanges(config.Fields()));
  if (spec.method == kNoMethod) return absl::OkStatus();
  const api::AugmentSpec augment = AugmentSpecOf(spec, /*seed=*/0);
  return synthesis::CreateMethod(augment.method, {.action_class = augment.action_class,
                                                  .preset = augment.preset,
                                                  .overrides = augment.overrides})
      .status();
}

class CorrectFlow::Implementation {
 public:
  Implementation(const api::CorrectSpec& spec, uint64_t seed, const CorrectionConfig& config,
                 std::vector<Source> sources, std::unique_ptr<AugmentFlow> augment)
      : method(spec.method),
        seed(seed),
        variants_per_source(spec.Variants()),
        rollouts(config.effort == "instant" ? 1 : config.learning.rollouts),
        sources(std::move(sources)),
        augment(std::move(augment)) {}

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
    auto correction = source.corrector.Correct(clip, context);
    if (!absl::IsDeadlineExceeded(correction.status())) return correction;
    base::RunContext rest = context;
    rest.deadline = last_call;
    correction = source.quick.Correct(clip, rest);
    if (correction.ok()) correction->timed_out = true;
    return correction;
  }

  const std::string method;
  const uint64_t seed;
  const int variants_per_source;
  const int rollouts;
  const std::vector<Source> sources;
  const std::unique_ptr<AugmentFlow> augment;  // none for the method none
};

CorrectFlow::CorrectFlow(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
CorrectFlow::~CorrectFlow() = default;

StatusOr<std::unique_ptr<CorrectFlow>> CorrectFlow::Create(const api::CorrectSpec& spec,
                                                           uint64_t seed,
                                                           std::vector<ResolvedSource> sources) {
  POISE_RETURN_IF_ERROR(CheckCorrect(spec));
  POISE_ASSIGN_OR_RETURN(const CorrectionConfig config, ConfigOf(spec));
  std::unique_ptr<AugmentFlow> augment;
  if (spec.method != kNoMethod) {
    POISE_ASSIGN_OR_RETURN(augment, AugmentFlow::Create(AugmentSpecOf(spec, seed), sources));
  }
  std::vector<Source> made;
  for (ResolvedSource& source : sources) {
    const std::string field = fmt::format("sources[{}]", made.size());
    const std::string clip = fmt::format("clip '{}'", source.clip.name());
    StatusOr<Source> one = MakeSource(std::move(source), config);
    if (!one.ok()) return base::Annotate(one.status(), clip, field);
    made.push_back(*std::move(one));
  }
  return std::unique_ptr<CorrectFlow>(new CorrectFlow(
      std::make_unique<Implementation>(spec, seed, config, std::move(made), std::move(augment))));
}

int CorrectFlow::num_sources() const { return static_cast<int>(implementation_->sources.size()); }
int CorrectFlow::variants_per_source() const { return implementation_->variants_per_source; }
int CorrectFlow::rollouts() const { return implementation_->rollouts; }

int64_t CorrectFlow::num_variants() const {
  return int64_t{num_sources()} * implementation_->variants_per_source;
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
