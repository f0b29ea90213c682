#ifndef POISE_CORE_MOTION_DATASET_BENCHMARK_CLIPS_H_
#define POISE_CORE_MOTION_DATASET_BENCHMARK_CLIPS_H_

#include <filesystem>
#include <string>
#include <vector>

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
