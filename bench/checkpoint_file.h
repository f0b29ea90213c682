#ifndef POISE_BENCH_CHECKPOINT_FILE_H_
#define POISE_BENCH_CHECKPOINT_FILE_H_

#include <optional>
#include <string>

#include "core/learning/nn/checkpoint_sink.h"

namespace poise::bench {

/// The newest checkpoint of a training in one file, from which it goes on after an interruption.
class CheckpointFile {
 public:
  /// Makes the folder of `path`.
  explicit CheckpointFile(std::string path);

  /// None: there is no such file.
  std::optional<std::string> Read() const;
  /// Lifetime: not beyond this object's.
  learning::CheckpointSink Sink(absl::Duration interval) const;
  void Remove() const;

 private:
  const std::string path_;
};

}  // namespace poise::bench

#endif  // POISE_BENCH_CHECKPOINT_FILE_H_
