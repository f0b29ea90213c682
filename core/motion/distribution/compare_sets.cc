#include "core/motion/distribution/compare_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace poise::motion {
namespace {

using Features = std::vector<MotionFeatures>;
using Frames = std::vector<FrameFeatures>;

enum Stream : uint64_t { kMade, kTraining };

constexpr int kMaxMotions = 1'000'000;

Status RequireTwo(const char* name, const Features& motions) {
  if (motions.size() >= 2) return absl::OkStatus();
  return base::InvalidArgument(
      "TOO_FEW_MOTIONS", name,
      fmt::format("a set is compared by at least 2 motions, '{}' has {}", name, motions.size()));
}

Frames RotationsOf(const Features& motions) {
  Frames frames;
  for (const MotionFeatures& motion : motions) frames.push_back(motion.rotations);
  return frames;
}

Eigen::MatrixXd Descriptors(const Features& motions) {
  Eigen::MatrixXd points(motions.size(), motions.front().descriptor.size());
  for (size_t i = 0; i < motions.size(); ++i) points.row(i) = motions[i].descriptor.transpose();
  return points;
}

// The least of `count` of the values, mean over all choices.
double MeanLeast(std::vector<double> values, size_t count) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size()), k = static_cast<double>(count);
  double mean = 0, probability = k / n;  // that values[i] is the least
  for (size_t i = 0; i < values.size(); ++i) {
    mean += probability * values[i];
    const double left = n - 1 - static_cast<double>(i);
    probability *= left > 0 ? std::max(left + 1 - k, 0.0) / left : 0;
  }
  return mean;
}

double MeanNearest(const FrameFeatures& motion, const Frames& set, size_t count) {
  std::vector<double> distances;
  for (const FrameFeatures& other : set) distances.push_back(DtwDistance(motion, other));
  return MeanLeast(std::move(distances), count);
}

template <typename Value>
double Mean(const Features& motions, Value value) {
  double sum = 0;
  for (const MotionFeatures& motion : motions) sum += motion.*value;
  return sum / static_cast<double>(motions.size());
}

class Comparison {
 public:
  Comparison(const MotionSets& sets, const CompareConfig& config, const base::RunContext& context)
      : sets_(sets), config_(config), context_(context) {}

  StatusOr<SetComparison> Run() {
    POISE_RETURN_IF_ERROR(Discrepancies());
    POISE_RETURN_IF_ERROR(NearestToReference());
    POISE_ASSIGN_OR_RETURN(result_.diversity, Diversity(RotationsOf(sets_.made)));
    POISE_ASSIGN_OR_RETURN(result_.diversity_training, Diversity(RotationsOf(sets_.training)));
    POISE_RETURN_IF_ERROR(Novelty());
    result_.mean_speed_mps = Mean(sets_.made, &MotionFeatures::mean_speed_mps);
    result_.mean_speed_training_mps = Mean(sets_.training, &MotionFeatures::mean_speed_mps);
    result_.foot_skate_mps = Mean(sets_.made, &MotionFeatures::foot_skate_mps);
    result_.foot_skate_training_mps = Mean(sets_.training, &MotionFeatures::foot_skate_mps);
    result_.odd_lengths = OddLengths();
    return result_;
  }

 private:
  base::Random Stream(uint64_t stream) const {
    return base::Random(base::DeriveSeed(context_.seed, {stream}));
  }

  StatusOr<MmdResult> Discrepancy(const Features& motions, uint64_t stream) const {
    base::Random random = Stream(stream);
    const SamplePair pair = DescriptorPair(motions, sets_.reference);
    return MaximumMeanDiscrepancy({&pair, 1}, config_.mmd, random);
  }

  Status Discrepancies() {
    POISE_ASSIGN_OR_RETURN(const MmdResult made, Discrepancy(sets_.made, kMade));
    POISE_ASSIGN_OR_RETURN(const MmdResult training, Discrepancy(sets_.training, kTraining));
    result_.mmd = made.squared_mmd;
    result_.mmd_p = made.p_value;
    result_.mmd_training = training.squared_mmd;
    return absl::OkStatus();
  }

  Status NearestToReference() {
    const size_t fewest = std::min(sets_.made.size(), sets_.training.size());
    const size_t count = config_.nearest_of == 0
                             ? fewest
                             : std::min<size_t>(static_cast<size_t>(config_.nearest_of), fewest);
    result_.nearest_of = static_cast<int>(count);
    const Frames made = RotationsOf(sets_.made), training = RotationsOf(sets_.training);
    for (const MotionFeatures& motion : sets_.reference) {
      POISE_RETURN_IF_ERROR(context_.Check());
      result_.min_dtw += MeanNearest(motion.rotations, made, count);
      result_.min_dtw_training += MeanNearest(motion.rotations, training, count);
    }
    result_.min_dtw /= static_cast<double>(sets_.reference.size());
    result_.min_dtw_training /= static_cast<double>(sets_.reference.size());
    return absl::OkStatus();
  }

  StatusOr<double> Diversity(const Frames& motions) const {
    double sum = 0;
    for (size_t i = 0; i < motions.size(); ++i) {
      POISE_RETURN_IF_ERROR(context_.Check());
      for (size_t j = 0; j < i; ++j) sum += DtwDistance(motions[i], motions[j]);
    }
    const double count = static_cast<double>(motions.size());
    return sum / (count * (count - 1) / 2);
  }

  Status Novelty() {
    const Frames training = RotationsOf(sets_.training);
    result_.novelty_least = std::numeric_limits<double>::infinity();
    for (const MotionFeatures& motion : sets_.made) {
      POISE_RETURN_IF_ERROR(context_.Check());
      const double distance = FindNearest(motion.rotations, training).distance;
      result_.novelty += distance;
      result_.novelty_least = std::min(result_.novelty_least, distance);
    }
    result_.novelty /= static_cast<double>(sets_.made.size());
    return absl::OkStatus();
  }

  double OddLengths() const {
    const auto shorter = [](const MotionFeatures& a, const MotionFeatures& b) {
      return a.duration_s < b.duration_s;
    };
    const auto [shortest, longest] =
        std::minmax_element(sets_.training.begin(), sets_.training.end(), shorter);
    const auto odd =
        std::count_if(sets_.made.begin(), sets_.made.end(), [&](const MotionFeatures& motion) {
          return motion.duration_s < 0.5 * shortest->duration_s ||
                 motion.duration_s > 2 * longest->duration_s;
        });
    return static_cast<double>(odd) / static_cast<double>(sets_.made.size());
  }

  const MotionSets& sets_;
  const CompareConfig& config_;
  const base::RunContext& context_;
  SetComparison result_;
};

}  // namespace

std::vector<base::Field> CompareConfig::Fields() {
  std::vector<base::Field> fields = {base::Number("nearest_of", &nearest_of, 0, kMaxMotions)};
  base::Append(fields, base::Nested("mmd", mmd.Fields()));
  return fields;
}

std::vector<base::Field> SetComparison::Fields() {
  constexpr double kMost = std::numeric_limits<double>::max();
  const auto number = [](const char* name, double* value) {
    return base::Number(name, value, -kMost, kMost);
  };
  return {number("mmd", &mmd),
          number("mmd_p", &mmd_p),
          number("mmd_training", &mmd_training),
          base::Number("nearest_of", &nearest_of, 0, kMaxMotions),
          number("min_dtw", &min_dtw),
          number("min_dtw_training", &min_dtw_training),
          number("diversity", &diversity),
          number("diversity_training", &diversity_training),
          number("novelty", &novelty),
          number("novelty_least", &novelty_least),
          number("mean_speed_mps", &mean_speed_mps),
          number("mean_speed_training_mps", &mean_speed_training_mps),
          number("foot_skate_mps", &foot_skate_mps),
          number("foot_skate_training_mps", &foot_skate_training_mps),
          number("odd_lengths", &odd_lengths)};
}

SamplePair DescriptorPair(const std::vector<MotionFeatures>& motions,
                          const std::vector<MotionFeatures>& reference) {
  return {Descriptors(motions), Descriptors(reference)};
}

StatusOr<SetComparison> CompareSets(const MotionSets& sets, const CompareConfig& config,
                                    const base::RunContext& context) {
  CompareConfig copy = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(copy.Fields()));
  POISE_RETURN_IF_ERROR(RequireTwo("made", sets.made));
  POISE_RETURN_IF_ERROR(RequireTwo("training", sets.training));
  POISE_RETURN_IF_ERROR(RequireTwo("reference", sets.reference));
  return Comparison(sets, config, context).Run();
}

}  // namespace poise::motion
