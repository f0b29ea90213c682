#ifndef POISE_CORE_MOTION_DATASET_BENCHMARK_CLIPS_H_
#define POISE_CORE_MOTION_DATASET_BENCHMARK_CLIPS_H_

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/config_fields.h"
#include "core/motion/dataset/labelled_clip.h"
#include "core/motion/metrics/euler_error.h"

namespace poise::motion {

/// The sequences of a published prediction benchmark, thinned out as published.
struct BenchmarkClips {
  std::vector<LabelledClip> train;
  std::vector<LabelledClip> test;
  RotationSense sense = RotationSense::kColumnVectors;  ///< of the published columns
  ColumnMask counts;                                    ///< columns that the error counts
  EulerErrorVariant variant = EulerErrorVariant::kMovingColumns;
};

/// The rate and body on which predictions are learned and tested.
struct BenchmarkForm {
  double frame_rate = 30;  ///< [Hz] 0: the clips' own, which must be one
  /// "roles": the 16 joints of MotionAug and all their columns, as HDM05 is tested.
  /// "all": every joint, and the columns that move, as CMU is tested (of row vectors).
  std::string body = "roles";

  std::vector<base::Field> Fields();
};

/// How clips of any data set become a benchmark.
struct BenchmarkRules {
  std::string action_class = {};  ///< IsOfClass; empty: all
  std::string hold_out = {};  ///< the actor whose clips are the test; empty: all are for training
  BenchmarkForm form = {};
};

/// Thinned out where the rate is a whole multiple, else interpolated.
/// Errors: kNotFound NO_CLIPS (of the class, or of the actor; the message lists those there are);
/// kFailedPrecondition MIXED_BODIES (other joints), MIXED_RATES; those of ReduceToRoles and
/// Resample with the clip's name.
StatusOr<BenchmarkClips> MakeBenchmark(std::vector<LabelledClip> clips,
                                       const BenchmarkRules& rules);

/// CMU rotation-vector text below `folder`/{train,test}/<action>/<action>_<k>.txt: the eight
/// actions as far as they are there, the first file of each action as its test, all of its training
/// files; every second row from the artificial row 0 on, as published (60 Hz). Columns that count
/// move in the rows of the training files before they are thinned out.
/// Source: reference sec. 1.1 to 1.7.
/// Errors: kNotFound FOLDER_NOT_FOUND, NO_CLIPS; those of ReadClipFile.
StatusOr<BenchmarkClips> LoadCmuBenchmark(const std::filesystem::path& folder);

/// HDM05 clips of one class below `folder`/<class>/ (of all where `action_class` is empty), on the
/// 16 joints of MotionAug, every fourth frame (30 Hz): the clips of the actor that is left out are
/// the test. Every column but the root's counts. Source: reference sec. 1.12. Errors: kNotFound
/// FOLDER_NOT_FOUND, NO_CLIPS (an actor without clips; the message lists those there are); those of
/// ReadClipFile and ReduceToRoles.
StatusOr<BenchmarkClips> LoadHdm05Benchmark(const std::filesystem::path& folder,
                                            const std::string& action_class,
                                            const std::string& left_out);

/// Actors with clips of a class, sorted. Errors: kNotFound FOLDER_NOT_FOUND.
StatusOr<std::vector<std::string>> Hdm05Actors(const std::filesystem::path& folder,
                                               const std::string& action_class);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_BENCHMARK_CLIPS_H_
