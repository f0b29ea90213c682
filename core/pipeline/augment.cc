#include "core/pipeline/augment.h"

#include <fmt/format.h>

#include <mutex>
#include <string>
#include <utility>

#include "core/base/random.h"
#include "core/motion/metrics/plausibility.h"
#include "core/synthesis/synthesizer_registry.h"

namespace poise::pipeline {
namespace {

using synthesis::BoundSynthesizer;
using synthesis::Draft;
using synthesis::MethodStep;

// One source and, once a variant of it was asked for, its first step bound to it.
struct Source {
  Source(motion::Clip clip, motion::JointRoles joint_roles)
      : draft{std::move(clip), std::nullopt}, roles(std::move(joint_roles)) {}

  Draft draft;
  motion::JointRoles roles;
  std::once_flag bind_once;
  StatusOr<std::unique_ptr<BoundSynthesizer>> bound;
};

std::string SourceField(int source) { return fmt::format("sources[{}]", source); }

Status CheckFinite(const motion::Clip& clip) {
  // A sum is finite only if all of its terms are: one test instead of one a number.
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const motion::Quat& rotation : clip.rotations()) sum += rotation.coeffs();
  motion::Vec3 root = motion::Vec3::Zero();
  for (const motion::Vec3& position : clip.root_positions()) root += position;
  if (sum.allFinite() && root.allFinite()) return absl::OkStatus();
  return base::Internal("NOT_FINITE",
                        fmt::format("variant '{}' holds a number that is not finite", clip.name()));
}

}  // namespace

class AugmentFlow::Implementation {
 public:
  Implementation(const api::AugmentSpec& spec, std::vector<MethodStep> steps,
                 std::vector<ResolvedSource> sources)
      : method_(spec.method),
        variants_per_source_(spec.variants_per_source),
        seed_(spec.seed),
        with_plausibility_(spec.with_plausibility),
        steps_(std::move(steps)) {
    for (ResolvedSource& source : sources) {
      sources_.push_back(std::make_unique<Source>(std::move(source.clip), std::move(source.roles)));
    }
  }

  Status CheckSources() const {
    for (size_t i = 0; i < sources_.size(); ++i) {
      const Source& source = *sources_[i];
      if (with_plausibility_) {
        POISE_RETURN_IF_ERROR(
            base::Annotate(source.roles.RequireComplete(), "plausibility", SourceField(i)));
      }
      for (const MethodStep& step : steps_) {
        POISE_RETURN_IF_ERROR(
            base::Annotate(step.synthesizer->Check(source.draft.clip, source.roles),
                           fmt::format("method step '{}'", step.name), SourceField(i)));
      }
    }
    return absl::OkStatus();
  }

  int64_t num_variants() const {
    return static_cast<int64_t>(sources_.size()) * variants_per_source_;
  }

  StatusOr<api::Variant> Make(int64_t ordinal, const base::RunContext& context) const {
    if (ordinal < 0 || ordinal >= num_variants()) {
      return base::InvalidArgument(
          "BAD_VARIANT_ORDINAL", "ordinal",
          fmt::format("variant {} of {} was asked for", ordinal, num_variants()));
    }
    const int source_index = static_cast<int>(ordinal / variants_per_source_);
    const int index = static_cast<int>(ordinal % variants_per_source_);
    Source& source = *sources_[source_index];
    const uint64_t seed = base::DeriveSeed(
        seed_, {static_cast<uint64_t>(source_index), static_cast<uint64_t>(index)});
    const auto annotate = [&](const Status& status) {
      return base::Annotate(status, fmt::format("variant {} of source {}", index, source_index),
                            SourceField(source_index));
    };

    StatusOr<Draft> draft = RunSteps(source, seed, context);
    if (!draft.ok()) return annotate(draft.status());
    draft->clip.set_name(fmt::format("{}_{}_{}", source.draft.clip.name(), method_, index));
    POISE_RETURN_IF_ERROR(CheckFinite(draft->clip));
    api::Variant variant{.source_index = source_index,
                         .index = index,
                         .seed = seed,
                         .clip = std::move(draft->clip),
                         .ik = draft->ik,
                         .plausibility = std::nullopt};
    if (with_plausibility_) {
      POISE_RETURN_IF_ERROR(context.Check());
      auto plausibility = motion::AssessPlausibility(variant.clip, source.roles);
      if (!plausibility.ok()) return annotate(plausibility.status());
      variant.plausibility = *plausibility;
    }
    return variant;
  }

 private:
  // Each step has its own random stream, so that a step more changes no draw of those before it.
  StatusOr<Draft> RunSteps(Source& source, uint64_t seed, const base::RunContext& context) const {
    POISE_RETURN_IF_ERROR(context.Check());
    std::call_once(source.bind_once, [&] {
      source.bound = steps_.front().synthesizer->Bind(source.draft, source.roles);
    });
    POISE_RETURN_IF_ERROR(source.bound.status());
    base::Random random(base::DeriveSeed(seed, {0}));
    POISE_ASSIGN_OR_RETURN(Draft draft, (*source.bound)->Sample(random, context));
    for (size_t i = 1; i < steps_.size(); ++i) {
      random = base::Random(base::DeriveSeed(seed, {i}));
      POISE_ASSIGN_OR_RETURN(const auto bound, steps_[i].synthesizer->Bind(draft, source.roles));
      POISE_ASSIGN_OR_RETURN(Draft next, bound->Sample(random, context));
      draft = std::move(next);
    }
    return draft;
  }

  const std::string method_;
  const int variants_per_source_;
  const uint64_t seed_;
  const bool with_plausibility_;
  const std::vector<MethodStep> steps_;
  std::vector<std::unique_ptr<Source>> sources_;
};

AugmentFlow::AugmentFlow(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
AugmentFlow::~AugmentFlow() = default;

StatusOr<std::unique_ptr<AugmentFlow>> AugmentFlow::Create(const api::AugmentSpec& spec,
                                                           std::vector<ResolvedSource> sources,
                                                           MotionDecoderPtr decoder) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  POISE_ASSIGN_OR_RETURN(auto steps,
                         synthesis::CreateMethod(spec.method, {.action_class = spec.action_class,
                                                               .preset = spec.preset,
                                                               .overrides = spec.overrides,
                                                               .decoder = std::move(decoder)}));
  auto implementation =
      std::make_unique<Implementation>(spec, std::move(steps), std::move(sources));
  POISE_RETURN_IF_ERROR(implementation->CheckSources());
  return std::unique_ptr<AugmentFlow>(new AugmentFlow(std::move(implementation)));
}

int64_t AugmentFlow::num_variants() const { return implementation_->num_variants(); }

StatusOr<api::Variant> AugmentFlow::Make(int64_t ordinal, const base::RunContext& context) const {
  return implementation_->Make(ordinal, context);
}

}  // namespace poise::pipeline
