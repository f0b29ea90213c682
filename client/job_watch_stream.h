#ifndef POISE_CLIENT_JOB_WATCH_STREAM_H_
#define POISE_CLIENT_JOB_WATCH_STREAM_H_

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "client/backoff.h"
#include "client/connection.h"
#include "client/job_watch.h"

namespace poise::client {

/// The gRPC side of a JobWatch: one WatchJob call after the other.
class JobWatch::Stream {
 public:
  Stream(const Connection& connection, std::string id, const WatchOptions& options);
  ~Stream();

  StatusOr<std::optional<api::JobEvent>> Next();
  void Cancel();
  const api::Job& job() const { return job_; }
  int64_t last_seq() const { return last_seq_; }

 private:
  // False: cancelled.
  bool Join();
  // The error with which the stream that broke ends the watch, or OK: it may be joined again.
  Status Break();
  StatusOr<std::optional<api::JobEvent>> Take(const v1::WatchJobResponse& response);
  void TakeSnapshot(api::Job job);
  void Apply(const api::JobEvent& event);
  // OK when the time is over, or the server is back; errors: kCancelled.
  Status Wait(absl::Duration delay);

  const Connection& connection_;
  const std::string id_;
  const absl::Time deadline_;
  Backoff backoff_;

  std::unique_ptr<grpc::ClientContext> context_;  // changed under mutex_
  std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> reader_;
  bool joined_ = false;  // this stream has given its first snapshot
  api::Job job_;
  int64_t last_seq_;
  std::optional<Status> outcome_;  // once there is nothing more to come

  std::mutex mutex_;
  bool cancelled_ = false;
};

}  // namespace poise::client

#endif  // POISE_CLIENT_JOB_WATCH_STREAM_H_
