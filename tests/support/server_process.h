#ifndef POISE_TESTS_SUPPORT_SERVER_PROCESS_H_
#define POISE_TESTS_SUPPORT_SERVER_PROCESS_H_

#include <grpcpp/channel.h>
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {

/// A real poised on a free port, with a data folder of its own, unless the flags name one; killed
/// at the end if it still runs.
class ServerProcess {
 public:
  /// Starts it and waits for its ready line. When it ends without one, ready() is empty.
  explicit ServerProcess(const std::vector<std::string>& flags = {});
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  const base::Json& ready() const { return ready_; }
  std::string address() const { return ready_["address"]; }
  std::shared_ptr<grpc::Channel> NewChannel() const;
  pid_t pid() const { return pid_; }

  void Signal(int number) const;
  /// The exit code, or 128 + the signal's number; waits.
  int Wait();

  /// What it wrote to stderr so far.
  std::string Log() const;
  int64_t ResidentBytes() const;
  double CpuSeconds() const;
  /// A variable of the environment that it runs with, or "unset".
  std::string Environment(const std::string& name) const;

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  base::Json ready_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_SERVER_PROCESS_H_
