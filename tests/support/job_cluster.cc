#include "tests/support/job_cluster.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <sstream>

namespace poise::testing {
namespace {

namespace fs = std::filesystem;

constexpr absl::Duration kStart = absl::Seconds(30);

std::shared_ptr<grpc::Channel> QuickChannel(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 50);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 50);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

// Below the range from which the system takes ports for connections, so that nobody gets it while
// the server is down.
int RandomPort() {
  static std::mt19937 engine{std::random_device()()};
  return std::uniform_int_distribution<int>(20'000, 32'000)(engine);
}

std::string Logs(const std::vector<std::unique_ptr<Process>>& processes) {
  std::string logs;
  for (const auto& process : processes) logs += process->ErrorOutput();
  return logs;
}

}  // namespace

JobCluster::JobCluster(std::vector<std::string> server_flags)
    : server_flags_(std::move(server_flags)) {
  for (int tries = 0; tries < 10; ++tries) {
    address_ = fmt::format("127.0.0.1:{}", RandomPort());
    metrics_address_ = fmt::format("127.0.0.1:{}", RandomPort());
    if (StartServer()) break;
  }
  channel_ = QuickChannel(address_);
}

bool JobCluster::StartServer(const std::map<std::string, std::string>& environment) {
  std::vector<std::string> words = {POISE_POISED_PROGRAM, "--data-dir", data_dir().string(),
                                    "--listen",           address_,     "--metrics",
                                    metrics_address_};
  words.insert(words.end(), server_flags_.begin(), server_flags_.end());
  servers_.push_back(std::make_unique<Process>(words, environment));
  const bool ready = server().WaitForOutput("\"ready\"", kStart);
  if (!ready) {
    std::printf("poised did not start: %s\n", server().ErrorOutput().c_str());
  }
  return ready;
}

int JobCluster::StopServer(int signal) {
  server().Signal(signal);
  return server().Wait().value_or(-1000);
}

size_t JobCluster::StartWorker(const std::vector<std::string>& flags,
                               const std::map<std::string, std::string>& environment) {
  const fs::path work = folder_.path() / fmt::format("worker-{}", workers_.size());
  std::vector<std::string> words = {POISE_WORKER_PROGRAM, "--server", address_, "--work-dir",
                                    work.string()};
  words.insert(words.end(), flags.begin(), flags.end());
  workers_.push_back(std::make_unique<Process>(words, environment));
  EXPECT_TRUE(workers_.back()->WaitForOutput("\"ready\"", kStart))
      << workers_.back()->ErrorOutput();
  return workers_.size() - 1;
}

double JobCluster::Metric(const std::string& name, const std::vector<std::string>& parts) const {
  const auto answer = httplib::Client("http://" + metrics_address_).Get("/metrics");
  std::istringstream page(answer ? answer->body : "");
  double sum = 0;
  for (std::string line; std::getline(page, line);) {
    const bool named = line.starts_with(name + " ") || line.starts_with(name + "{");
    const bool fits = std::all_of(parts.begin(), parts.end(), [&](const std::string& part) {
      return line.find(part) != std::string::npos;
    });
    if (named && fits) sum += std::atof(line.c_str() + line.rfind(' '));
  }
  return sum;
}

std::string JobCluster::ServerLogs() const { return Logs(servers_); }
std::string JobCluster::WorkerLogs() const { return Logs(workers_); }

int FromEnvironment(const char* name, int otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : std::atoi(value);
}

}  // namespace poise::testing
