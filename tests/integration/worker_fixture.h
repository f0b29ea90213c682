#ifndef POISE_TESTS_INTEGRATION_WORKER_FIXTURE_H_
#define POISE_TESTS_INTEGRATION_WORKER_FIXTURE_H_

#include <grpcpp/channel.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "core/base/json.h"
#include "poise/v1/job.pb.h"
#include "tests/support/job_client.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {

/// A poise-worker that runs beside the test.
class Worker {
 public:
  Worker(const std::vector<std::string>& arguments,
         const std::map<std::string, std::string>& environment)
      : process(arguments, environment) {}

  /// Waits for its ready line.
  bool WaitUntilReady();
  /// The processes of its jobs.
  std::vector<pid_t> Children() const;
  bool HasChildren() const { return !Children().empty(); }

  Process process;
};

/// A real poised and real workers over one data folder; leases are short unless a test says
/// otherwise.
class WorkerFixture : public ::testing::Test {
 protected:
  using Flags = std::vector<std::string>;
  using Environment = std::map<std::string, std::string>;

  static Flags ShortLeases();
  pid_t server_pid() const;
  /// On the same port as before, if it ran before.
  void StartServer(const Flags& flags = ShortLeases(), const Environment& environment = {});
  std::unique_ptr<Worker> StartWorker(const Flags& flags = {}, const Environment& environment = {});

  /// Returns its name.
  std::string Submit(const base::Json& parameters, const v1::JobLimits& limits = {});
  v1::Job Get(const std::string& name);
  /// Waits until the job is as wished; a failure when that takes longer than `limit`.
  v1::Job WaitFor(const std::string& name, const std::function<bool(const v1::Job&)>& wish,
                  absl::Duration limit = absl::Seconds(60));
  v1::Job WaitForState(const std::string& name, v1::Job::State state);
  v1::Job WaitForStep(const std::string& name, int64_t step);
  v1::Job WaitForEnd(const std::string& name);

  /// Artifact by file name: equal for equal bytes.
  static std::map<std::string, std::string> Artifacts(const v1::Job& job);

  TemporaryFolder folder_;
  std::string address_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<JobClient> client_;
  std::unique_ptr<Process> server_;
};

/// Asks again and again; false when `limit` is over first.
bool Eventually(const std::function<bool()>& condition, absl::Duration limit);

}  // namespace poise::testing

#endif  // POISE_TESTS_INTEGRATION_WORKER_FIXTURE_H_
