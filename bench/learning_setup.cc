#include "bench/learning_setup.h"

#include <CLI/CLI.hpp>

#include "bench/overrides.h"
#include "core/base/random.h"
#include "core/motion/io/clip_file.h"

namespace poise::bench {
namespace {

constexpr uint64_t kTestStream = 1, kTrainingStream = 2;

std::unique_ptr<pipeline::AugmentFlow> Variants(const LearningOptions& options,
                                                const motion::Clip& clip,
                                                const motion::JointRoles& roles, uint64_t stream) {
  api::AugmentSpec spec;
  spec.sources = {api::ClipSource{clip, {}}};
  spec.method = "ik";
  spec.action_class = options.action_class;
  spec.variants_per_source = static_cast<int>(correction::kVariantDraws);
  spec.seed = base::DeriveSeed(options.seed, {stream});
  spec.with_plausibility = false;
  return Must(pipeline::AugmentFlow::Create(spec, {{clip, roles}}));
}

}  // namespace

void Must(const Status& status) {
  if (status.ok()) return;
  fmt::print(stderr, "{}\n", base::Message(status));
  std::exit(1);
}

void LearningOptions::AddTo(CLI::App& app) {
  app.add_option("clip", clip, "motion file")->required();
  app.add_option("--class", action_class, "preset of the IK targets");
  app.add_option("--seed", seed, "of the variants and of training");
  app.add_option("--preset", preset, "recommended | paper");
  app.add_option("--reward", reward, "motionaug | rfc | deepmimic");
  app.add_option("--set", overrides, "KEY=VALUE of the imitation, or correction.KEY");
  app.add_option("--csv", csv, "append the rows to this file");
  app.add_option("--commit", commit, "written into each row");
}

LearningSetup LearningSetup::From(const LearningOptions& options, std::vector<base::Field> more) {
  motion::Clip clip = Must(motion::ReadClipFile(options.clip)).clip;
  motion::JointRoles roles = Must(motion::JointRoles::Detect(*clip.skeleton()));
  auto correction = Must(correction::CorrectionConfig::FromPreset(options.preset));
  auto imitation = Must(correction::ImitationConfig::FromPreset(options.preset));
  correction.reward = Must(correction::RewardConfig::FromPreset(options.reward));
  std::vector<base::Field> fields = imitation.Fields();
  base::Append(fields, base::Nested("correction", correction.Fields()));
  base::Append(fields, std::move(more));
  Must(base::ApplyOverrides(ToOverrides(options.overrides), fields));
  auto test = Variants(options, clip, roles, kTestStream);
  auto training = Variants(options, clip, roles, kTrainingStream);
  return {.clip = std::move(clip),
          .roles = std::move(roles),
          .correction = std::move(correction),
          .imitation = std::move(imitation),
          .test = std::move(test),
          .training = std::move(training)};
}

correction::VariantSource LearningSetup::TrainingVariants() const {
  return [this](uint64_t draw) -> StatusOr<motion::Clip> {
    POISE_ASSIGN_OR_RETURN(api::Variant variant, training->Make(static_cast<int64_t>(draw), {}));
    return std::move(variant.clip);
  };
}

CsvFile::CsvFile(const std::string& path, const std::string& head) {
  std::ifstream old(path);
  const bool fresh = !old.good() || old.peek() == std::ifstream::traits_type::eof();
  if (!path.empty()) file_.open(path, std::ios::app);
  if (fresh) file_ << head << "\n";
  fmt::print("{}\n", head);
}

void CsvFile::Add(const std::string& row) {
  file_ << row << "\n" << std::flush;
  fmt::print("{}\n", row);
  std::fflush(stdout);
}

}  // namespace poise::bench
