#include "core/runtime/jobs/child_watch.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <utility>

namespace poise::jobs {
namespace {

constexpr size_t kBlockBytes = size_t{64} << 10;

Status ProcessLost(std::string_view how, std::string_view last_words) {
  return base::MakeError(absl::StatusCode::kUnavailable, "PROCESS_LOST", "",
                         fmt::format("the process of the attempt {}{}{}", how,
                                     last_words.empty() ? "" : "; its last words: ", last_words));
}

// Appends what is there to `lines`; false when there is nothing. Clears `open` at the stream's end.
bool ReadAvailable(int descriptor, LineBuffer& lines, bool& open) {
  if (!open) return false;
  char block[kBlockBytes];
  const ssize_t count = read(descriptor, block, sizeof(block));
  if (count > 0) lines.Append({block, static_cast<size_t>(count)});
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) open = false;
  return count > 0;
}

}  // namespace

ChildWatch::ChildWatch(const ChildProcessConfig& config, const RunInput& input,
                       const JobContext& context, std::unique_ptr<ChildProcess> process)
    : config_(config),
      input_(input),
      context_(context),
      process_(std::move(process)),
      channel_(config.max_message_bytes),
      output_(config.max_output_line_bytes) {}

StatusOr<RunOutput> ChildWatch::Run(const ChildStart& start) {
  to_send_ = EncodeLine(start);
  while (true) {
    WaitForBytes();
    SendStart();
    ReadChannel();
    ReadOutput();
    Supervise();
    if (const auto exit = process_->Poll()) {
      exit_ = *exit;
      return Conclude();
    }
  }
}

void ChildWatch::WaitForBytes() {
  // poll overlooks descriptors below 0.
  pollfd waiting[] = {
      {.fd = channel_open_ ? process_->channel() : -1, .events = POLLIN, .revents = 0},
      {.fd = output_open_ ? process_->output() : -1, .events = POLLIN, .revents = 0}};
  if (!to_send_.empty()) waiting[0].events |= POLLOUT;
  poll(waiting, std::size(waiting),
       static_cast<int>(absl::ToInt64Milliseconds(config_.poll_interval)));
}

void ChildWatch::SendStart() {
  if (to_send_.empty()) return;
  const ssize_t sent = send(process_->channel(), to_send_.data(), to_send_.size(), MSG_NOSIGNAL);
  if (sent > 0) to_send_.erase(0, static_cast<size_t>(sent));
  if (sent < 0 && errno == EPIPE) to_send_.clear();  // its exit says the rest
}

bool ChildWatch::ReadChannel() {
  const bool more = ReadAvailable(process_->channel(), channel_, channel_open_);
  while (const auto line = channel_.Next()) Handle(*line);
  return more;
}

bool ChildWatch::ReadOutput() {
  const bool more = ReadAvailable(process_->output(), output_, output_open_);
  while (auto line = output_.Next()) ForwardOutput(std::move(*line));
  return more;
}

void ChildWatch::Handle(const std::string& line) {
  StatusOr<ChildMessage> message = DecodeMessage(line);
  if (!message.ok()) return GiveUp(message.status());
  if (const auto* progress = std::get_if<base::Progress>(&*message)) TakeProgress(*progress);
  if (const auto* checkpoint = std::get_if<ChildCheckpoint>(&*message)) TakeCheckpoint(*checkpoint);
  if (auto* output = std::get_if<RunOutput>(&*message)) result_ = std::move(*output);
  if (const auto* error = std::get_if<api::JobError>(&*message)) result_ = error->ToStatus();
  if (result_ && !end_time_) end_time_ = Clock::now();
}

void ChildWatch::TakeProgress(const base::Progress& progress) {
  if (progress.step != step_) step_time_ = Clock::now();
  step_ = progress.step;
  context_.run.Report(progress);
}

void ChildWatch::TakeCheckpoint(const ChildCheckpoint& checkpoint) {
  std::ifstream stream(checkpoint.file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  if (!stream.good()) return GiveUp(base::Internal("CHILD_PROTOCOL", "a checkpoint is not there"));
  stream.close();
  std::error_code ignored;
  std::filesystem::remove(checkpoint.file, ignored);
  const Status saved = context_.save_checkpoint(bytes, checkpoint.step);
  if (!saved.ok()) GiveUp(saved);
}

void ChildWatch::ForwardOutput(std::string line) {
  if (config_.on_output && output_lines_ < config_.max_output_lines) config_.on_output(line);
  ++output_lines_;
  last_output_line_ = std::move(line);
}

void ChildWatch::GiveUp(Status why) {
  if (given_up_.ok()) given_up_ = std::move(why);
  process_->Kill();
}

void ChildWatch::Supervise() {
  const Clock::time_point now = Clock::now();
  const auto passed = [now](Clock::time_point since, absl::Duration limit) {
    return absl::FromChrono(now - since) >= limit;
  };
  if (end_time_) {
    if (passed(*end_time_, config_.exit_grace)) process_->Kill();
    return;
  }
  if (!stop_time_ && !context_.run.Check().ok()) {
    stop_time_ = now;
    process_->AskToStop();
  }
  if (stop_time_) {
    if (passed(*stop_time_, config_.stop_grace())) process_->Kill();
  } else if (passed(step_time_, config_.stall_timeout)) {
    GiveUp(
        base::MakeError(absl::StatusCode::kUnavailable, "STALLED", "",
                        fmt::format("no step after step {} within {}", std::max<int64_t>(step_, 0),
                                    absl::FormatDuration(config_.stall_timeout))));
  }
}

StatusOr<RunOutput> ChildWatch::Conclude() {
  // What it wrote before it ended is still there to be read. (Not until the stream ends: what it
  // started may hold that open.)
  while (ReadChannel()) {
  }
  while (ReadOutput()) {
  }
  if (std::string rest = output_.Rest(); !rest.empty()) ForwardOutput(std::move(rest));
  if (config_.on_output && output_lines_ > config_.max_output_lines) {
    config_.on_output(fmt::format("({} more lines)", output_lines_ - config_.max_output_lines));
  }
  if (!given_up_.ok()) return given_up_;
  if (result_ && result_->ok()) return std::move(*result_);
  POISE_RETURN_IF_ERROR(context_.run.Check());
  if (!result_) return ProcessLost(exit_.Describe(), last_output_line_);
  if (absl::IsCancelled(result_->status())) return ProcessLost("was told to stop by another", "");
  return result_->status();
}

}  // namespace poise::jobs
