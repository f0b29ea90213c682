#include "core/synthesis/synthesizer_registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/synthesis/ik/ik_synthesizer.h"
#include "core/synthesis/mirror/mirror_synthesizer.h"
#include "core/synthesis/noise/noise_synthesizer.h"
#include "core/synthesis/timewarp/timewarp_synthesizer.h"
#include "core/synthesis/vae/vae_synthesizer.h"

namespace poise::synthesis {
namespace {

using SynthesizerPtr = std::unique_ptr<Synthesizer>;

// `options.overrides` hold the step's own keys only.
StatusOr<SynthesizerPtr> CreateIk(const SynthesisOptions& options) {
  POISE_ASSIGN_OR_RETURN(const ActionClass action_class, FindActionClass(options.action_class));
  POISE_ASSIGN_OR_RETURN(IkConfig config, IkConfig::FromPreset(options.preset, action_class));
  POISE_RETURN_IF_ERROR(
      base::ApplyOverrides(options.overrides, base::Nested("ik", config.Fields())));
  POISE_RETURN_IF_ERROR(config.Validate());
  return SynthesizerPtr(std::make_unique<IkSynthesizer>(action_class, config));
}

StatusOr<SynthesizerPtr> CreateTimewarp(const SynthesisOptions& options) {
  TimewarpConfig config;
  POISE_RETURN_IF_ERROR(
      base::ApplyOverrides(options.overrides, base::Nested("timewarp", config.Fields())));
  POISE_RETURN_IF_ERROR(config.Validate());
  return SynthesizerPtr(std::make_unique<TimewarpSynthesizer>(config));
}

StatusOr<SynthesizerPtr> CreateNoise(const SynthesisOptions& options) {
  NoiseConfig config;
  POISE_RETURN_IF_ERROR(
      base::ApplyOverrides(options.overrides, base::Nested("noise", config.Fields())));
  return SynthesizerPtr(std::make_unique<NoiseSynthesizer>(config));
}

StatusOr<SynthesizerPtr> CreateMirror(const SynthesisOptions& options) {
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(options.overrides, {}));
  return SynthesizerPtr(std::make_unique<MirrorSynthesizer>());
}

StatusOr<SynthesizerPtr> CreateVae(const SynthesisOptions& options) {
  LatentSamplerConfig config;
  POISE_RETURN_IF_ERROR(
      base::ApplyOverrides(options.overrides, base::Nested("vae", config.Fields())));
  if (options.check_only) return SynthesizerPtr();
  if (options.decoder == nullptr) {
    return base::InvalidArgument("MISSING_MODEL", "model",
                                 "method 'vae' needs a model: say which (NAME or NAME@VERSION)");
  }
  return SynthesizerPtr(std::make_unique<VaeSynthesizer>(options.decoder, config));
}

struct Entry {
  const char* name;
  StatusOr<SynthesizerPtr> (*create)(const SynthesisOptions& options);
};

constexpr Entry kSteps[] = {
    {"ik", CreateIk},         {"timewarp", CreateTimewarp}, {"noise", CreateNoise},
    {"mirror", CreateMirror}, {"vae", CreateVae},
};

std::vector<std::string> SplitMethod(std::string_view method) {
  std::vector<std::string> names;
  while (true) {
    const size_t plus = method.find('+');
    names.emplace_back(method.substr(0, plus));
    if (plus == std::string_view::npos) return names;
    method.remove_prefix(plus + 1);
  }
}

Status UnknownStep(const std::string& name, std::string_view method) {
  const std::string nearest = base::NearestName(name, MethodStepNames());
  return base::InvalidArgument(
      "UNKNOWN_METHOD", "method",
      fmt::format("unknown step '{}' in method '{}'; steps: {}, joined by '+'{}", name, method,
                  fmt::join(MethodStepNames(), ", "),
                  nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

// Every override must belong to a step of this method: one that nothing reads is a mistake.
Status CheckOwners(const base::Overrides& overrides, const std::vector<std::string>& steps) {
  for (const auto& [key, value] : overrides) {
    const std::string owner = key.substr(0, key.find('.'));
    if (key.find('.') != std::string::npos &&
        std::find(steps.begin(), steps.end(), owner) != steps.end()) {
      continue;
    }
    return base::InvalidArgument(
        "UNKNOWN_CONFIG_KEY", key,
        fmt::format("unknown setting '{}': settings begin with a step of the method and a dot "
                    "(steps here: {})",
                    key, fmt::join(steps, ", ")));
  }
  return absl::OkStatus();
}

base::Overrides OwnOverrides(const base::Overrides& overrides, const std::string& step) {
  base::Overrides own;
  for (const auto& [key, value] : overrides) {
    if (key.starts_with(step + ".")) own[key] = value;
  }
  return own;
}

}  // namespace

std::vector<std::string> MethodStepNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kSteps) names.push_back(entry.name);
  return names;
}

StatusOr<std::vector<MethodStep>> CreateMethod(std::string_view method,
                                               const SynthesisOptions& options) {
  const std::vector<std::string> names = SplitMethod(method);
  if (names.size() > kMaxMethodSteps) {
    return base::InvalidArgument(
        "TOO_MANY_STEPS", "method",
        fmt::format("method has {} steps, at most {} expected", names.size(), kMaxMethodSteps));
  }
  std::vector<const Entry*> entries;
  for (const std::string& name : names) {
    const auto* const entry = std::find_if(std::begin(kSteps), std::end(kSteps),
                                           [&](const Entry& e) { return name == e.name; });
    if (entry == std::end(kSteps)) return UnknownStep(name, method);
    entries.push_back(entry);
  }
  POISE_RETURN_IF_ERROR(CheckOwners(options.overrides, names));
  std::vector<MethodStep> steps;
  for (const Entry* entry : entries) {
    SynthesisOptions own = options;
    own.overrides = OwnOverrides(options.overrides, entry->name);
    POISE_ASSIGN_OR_RETURN(SynthesizerPtr synthesizer, entry->create(own));
    steps.push_back({entry->name, std::move(synthesizer)});
  }
  return steps;
}

}  // namespace poise::synthesis
