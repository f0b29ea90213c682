#ifndef POISE_CORE_RUNTIME_JOBS_CHILD_MESSAGE_H_
#define POISE_CORE_RUNTIME_JOBS_CHILD_MESSAGE_H_

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "absl/time/time.h"
#include "core/api/job.h"
#include "core/base/run_context.h"
#include "core/runtime/jobs/job_runner.h"

/// What the process of an attempt and the one that watches it tell each other: one JSON object a
/// line. Large things are files in the attempt's folder, of which a line gives the path.
namespace poise::jobs {

/// Where both keep their own files, below RunInput::folder.
inline constexpr char kPrivateFolder[] = ".poise";

/// The one line to the child.
struct ChildStart {
  RunInput input;                         ///< without the bytes of the checkpoint
  std::filesystem::path checkpoint_file;  ///< empty: from the beginning
  absl::Duration checkpoint_interval = absl::Seconds(10);
  absl::Duration deadline_in = absl::InfiniteDuration();
};

/// A checkpoint that is on disk, complete.
struct ChildCheckpoint {
  std::filesystem::path file;
  int64_t step = 0;
};

/// Lines from the child: any number of the first two, then one of the last two.
using ChildMessage = std::variant<base::Progress, ChildCheckpoint, RunOutput, api::JobError>;

/// With the end of the line.
std::string EncodeLine(const ChildStart& start);
std::string EncodeLine(const ChildMessage& message);

/// Errors: kInternal CHILD_PROTOCOL.
StatusOr<ChildStart> DecodeStart(std::string_view line);
StatusOr<ChildMessage> DecodeMessage(std::string_view line);

/// Cuts a stream of bytes into lines.
class LineBuffer {
 public:
  explicit LineBuffer(size_t max_line_bytes) : max_line_bytes_(max_line_bytes) {}

  void Append(std::string_view bytes);
  /// The next line, without its end. One that is too long comes in pieces of the greatest length.
  std::optional<std::string> Next();
  /// What is there after the last end of line.
  std::string Rest();

 private:
  const size_t max_line_bytes_;
  std::string bytes_;
  size_t begin_ = 0;
  size_t searched_ = 0;  ///< no end of line before this
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_CHILD_MESSAGE_H_
