#ifndef POISE_TESTS_SUPPORT_JOB_CLUSTER_H_
#define POISE_TESTS_SUPPORT_JOB_CLUSTER_H_

#include <grpcpp/channel.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {

/// A real poised and real poise-workers over one data folder. Each may be killed and started again;
/// the server keeps its port. Everything is killed at the end.
class JobCluster {
 public:
  /// Starts the server. `server_flags` come after those that the cluster needs itself.
  explicit JobCluster(std::vector<std::string> server_flags = {});

  const std::string& address() const { return address_; }
  std::filesystem::path data_dir() const { return folder_.path() / "data"; }
  /// Connects again within 0.1 s when the server is back.
  std::shared_ptr<grpc::Channel> channel() const { return channel_; }

  Process& server() { return *servers_.back(); }
  /// Starts it again after its end. False: it did not become ready.
  bool StartServer(const std::map<std::string, std::string>& environment = {});
  /// Signals it and waits for its end; the exit code, or minus the signal.
  int StopServer(int signal);

  /// Starts a worker and waits for its ready line; returns its index.
  size_t StartWorker(const std::vector<std::string>& flags = {},
                     const std::map<std::string, std::string>& environment = {});
  Process& worker(size_t index) { return *workers_[index]; }
  size_t num_workers() const { return workers_.size(); }

  /// The value of a counter or gauge on the server's metrics page, summed over its labels (only
  /// lines that contain all of `parts`).
  double Metric(const std::string& name, const std::vector<std::string>& parts = {}) const;
  /// What all servers, or all workers, of this cluster have logged, oldest process first.
  std::string ServerLogs() const;
  std::string WorkerLogs() const;

 private:
  TemporaryFolder folder_;
  std::vector<std::string> server_flags_;
  std::string address_;
  std::string metrics_address_;
  std::shared_ptr<grpc::Channel> channel_;
  std::vector<std::unique_ptr<Process>> servers_;
  std::vector<std::unique_ptr<Process>> workers_;
};

/// A whole number from the environment, for longer runs on demand.
int FromEnvironment(const char* name, int otherwise);

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_JOB_CLUSTER_H_
