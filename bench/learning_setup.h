#ifndef POISE_BENCH_LEARNING_SETUP_H_
#define POISE_BENCH_LEARNING_SETUP_H_

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/correction/imitation/imitation_learner.h"
#include "core/pipeline/augment.h"

namespace CLI {
class App;
}

namespace poise::bench {

/// The value, or the end of the program with the error.
template <typename T>
T Must(StatusOr<T> value) {
  if (value.ok()) return *std::move(value);
  fmt::print(stderr, "{}\n", base::Message(value.status()));
  std::exit(1);
}
void Must(const Status& status);

/// What the programs that measure a policy of one clip have in common.
struct LearningOptions {
  std::string clip, action_class = "kick", preset = "recommended", reward = "motionaug";
  std::string csv, commit = "unknown";
  uint64_t seed = 1;
  std::vector<std::string> overrides;  // "ppo.noise=0.05", "correction.tracking.residual_factor=1"

  void AddTo(CLI::App& app);
};

/// One clip, how it is imitated, and two streams of its IK variants that share none.
struct LearningSetup {
  motion::Clip clip;
  motion::JointRoles roles;
  correction::CorrectionConfig correction;
  correction::ImitationConfig imitation;
  std::unique_ptr<pipeline::AugmentFlow> test, training;

  /// `more` are fields that overrides may name beside those of the configs. Ends the program on an
  /// error.
  static LearningSetup From(const LearningOptions& options, std::vector<base::Field> more = {});

  /// Makes variants of the training stream. Refers to the setup.
  correction::VariantSource TrainingVariants() const;
};

/// Rows at the end of a file, with the head where it is new; without a path only on the screen.
class CsvFile {
 public:
  CsvFile(const std::string& path, const std::string& head);
  void Add(const std::string& row);

 private:
  std::ofstream file_;
};

}  // namespace poise::bench

#endif  // POISE_BENCH_LEARNING_SETUP_H_
