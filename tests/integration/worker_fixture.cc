#include "tests/integration/worker_fixture.h"

#include <google/protobuf/util/json_util.h>
#include <grpcpp/create_channel.h>
#include <signal.h>

#include "absl/time/clock.h"
#include "tests/support/process_inspection.h"

namespace poise::testing {
namespace {

constexpr absl::Duration kStart = absl::Seconds(60);

}  // namespace

bool Eventually(const std::function<bool()>& condition, absl::Duration limit) {
  for (const absl::Time end = absl::Now() + limit; !condition();) {
    if (absl::Now() > end) return false;
    absl::SleepFor(absl::Milliseconds(10));
  }
  return true;
}

bool Worker::WaitUntilReady() { return process.WaitForOutput("\n", kStart); }

std::vector<pid_t> Worker::Children() const {
  const base::Json ready = base::Json::parse(process.Output(), nullptr, false);
  return ready.is_object() ? ChildrenOf(ready["pid"]) : std::vector<pid_t>();
}

pid_t WorkerFixture::server_pid() const { return base::Json::parse(server_->Output())["pid"]; }

WorkerFixture::Flags WorkerFixture::ShortLeases() {
  return {"--lease-seconds",         "3",   "--heartbeat-seconds", "0.5", "--reap-seconds",  "0.2",
          "--first-backoff-seconds", "0.1", "--lame-duck-seconds", "0.1", "--drain-seconds", "2"};
}

void WorkerFixture::StartServer(const Flags& flags, const Environment& environment) {
  Flags arguments = {POISE_POISED_PROGRAM, "--data-dir", (folder_.path() / "data").string(),
                     "--listen", address_.empty() ? "127.0.0.1:0" : address_};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  server_ = std::make_unique<Process>(arguments, environment);
  ASSERT_TRUE(server_->WaitForOutput("\n", kStart)) << server_->ErrorOutput();
  address_ = base::Json::parse(server_->Output())["address"];
  if (client_) return;
  grpc::ChannelArguments channel;
  channel.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  channel.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  channel.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 100);
  channel_ = grpc::CreateCustomChannel(address_, grpc::InsecureChannelCredentials(), channel);
  client_ = std::make_unique<JobClient>(channel_);
}

std::unique_ptr<Worker> WorkerFixture::StartWorker(const Flags& flags,
                                                   const Environment& environment) {
  Flags arguments = {POISE_WORKER_PROGRAM, "--server", address_, "--work-dir",
                     (folder_.path() / "work").string()};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  auto worker = std::make_unique<Worker>(arguments, environment);
  EXPECT_TRUE(worker->WaitUntilReady()) << worker->process.ErrorOutput();
  return worker;
}

std::string WorkerFixture::Submit(const base::Json& parameters, const v1::JobLimits& limits) {
  v1::CreateJobRequest request;
  request.mutable_spec()->set_kind("selftest");
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(
                  parameters.dump(), request.mutable_spec()->mutable_parameters())
                  .ok());
  request.set_seed(7);
  *request.mutable_limits() = limits;
  const StatusOr<v1::Job> job = client_->Create(request);
  EXPECT_TRUE(job.ok()) << job.status();
  return job.ok() ? job->name() : "";
}

v1::Job WorkerFixture::Get(const std::string& name) {
  const StatusOr<v1::Job> job = client_->Get(name);
  return job.ok() ? *job : v1::Job();
}

v1::Job WorkerFixture::WaitFor(const std::string& name,
                               const std::function<bool(const v1::Job&)>& wish,
                               absl::Duration limit) {
  v1::Job job;
  const bool came = Eventually(
      [&] {
        job = Get(name);
        return wish(job);
      },
      limit);
  EXPECT_TRUE(came) << job.DebugString();
  return job;
}

v1::Job WorkerFixture::WaitForState(const std::string& name, v1::Job::State state) {
  return WaitFor(name, [state](const v1::Job& job) { return job.state() == state; });
}

v1::Job WorkerFixture::WaitForStep(const std::string& name, int64_t step) {
  return WaitFor(name, [step](const v1::Job& job) {
    return job.state() == v1::Job::RUNNING && job.progress().step() >= step;
  });
}

v1::Job WorkerFixture::WaitForEnd(const std::string& name) {
  return WaitFor(name, [](const v1::Job& job) {
    return job.state() == v1::Job::SUCCEEDED || job.state() == v1::Job::FAILED ||
           job.state() == v1::Job::CANCELLED;
  });
}

std::map<std::string, std::string> WorkerFixture::Artifacts(const v1::Job& job) {
  std::map<std::string, std::string> artifacts;
  for (const v1::JobArtifact& artifact : job.artifacts()) {
    artifacts[artifact.name()] = artifact.artifact();
  }
  return artifacts;
}

}  // namespace poise::testing
