#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>

#include <cstdio>
#include <sstream>

#include "absl/time/clock.h"
#include "core/base/isa.h"
#include "core/base/version.h"
#include "tests/support/job_cluster.h"
#include "tests/support/raw_call.h"
#include "tests/support/server_process.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::ServerProcess;

TEST(PoisedStartTest, ReadyLineSaysWhereItListensAndHowFastItMultiplies) {
  ServerProcess server;
  ASSERT_FALSE(server.ready().empty()) << server.Log();
  std::printf("%s\n", server.ready().dump().c_str());
  EXPECT_EQ(server.ready()["event"], "ready");
  EXPECT_EQ(server.ready()["pid"], server.pid());
  EXPECT_EQ(server.ready()["version"], base::Version());
  EXPECT_GT(server.ready()["sgemm_gflops_per_core"], 0);
  EXPECT_EQ(testing::HealthOf(server.NewChannel(), ""), "SERVING");
  EXPECT_EQ(testing::HealthOf(server.NewChannel(), "poise.v1.AugmentationService"), "SERVING");
}

TEST(PoisedStartTest, LibrariesGetTheirEnvironmentEvenWhenTheCallerSetsNone) {
  unsetenv("OMP_WAIT_POLICY");
  setenv("OPENBLAS_CORETYPE", "SkylakeX", 1);
  ServerProcess server;
  unsetenv("OPENBLAS_CORETYPE");
  EXPECT_EQ(server.Environment("OMP_WAIT_POLICY"), "PASSIVE");
  const bool has_avx512 = base::BestIsa() == base::Isa::kV4;
  EXPECT_EQ(server.Environment("OPENBLAS_CORETYPE"), has_avx512 ? "SkylakeX" : "Haswell");
}

TEST(PoisedStartTest, SecondServerOnThePortEndsWithAClearMessage) {
  ServerProcess first;
  ServerProcess second({"--listen", first.address()});
  EXPECT_TRUE(second.ready().empty());
  EXPECT_EQ(second.Wait(), 4);
  EXPECT_THAT(second.Log(), ::testing::HasSubstr("cannot listen on " + first.address()));
}

TEST(PoisedStartTest, MetricsPageCountsCalls) {
  testing::JobCluster cluster;
  const grpc::Status status =
      testing::RawCall(cluster.channel(), "/poise.v1.AugmentationService/Augment", "\xff");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  // A call is counted when gRPC is done with it, a little after its caller is.
  const auto calls = [&] {
    return cluster.Metric("poise_requests_total", {"INVALID_ARGUMENT", "Augment"});
  };
  for (int tries = 0; calls() == 0 && tries < 100; ++tries) absl::SleepFor(absl::Milliseconds(50));
  EXPECT_EQ(calls(), 1);
  EXPECT_GT(cluster.Metric("poise_sgemm_gflops_per_core"), 0);
}

TEST(PoisedStartTest, BadFlagsEndWithExitCodeTwo) {
  EXPECT_EQ(ServerProcess({"--log-level", "loud"}).Wait(), 2);
  EXPECT_EQ(ServerProcess({"--store", "postgres://x"}).Wait(), 2);
  EXPECT_EQ(ServerProcess({"--no-such-flag"}).Wait(), 2);
}

TEST(PoisedStartTest, LogLinesAreJsonWithTheRequestId) {
  ServerProcess server;
  const grpc::Status status =
      testing::RawCall(server.NewChannel(), "/poise.v1.AugmentationService/Augment", "\xff");
  EXPECT_FALSE(status.ok());
  server.Signal(SIGINT);
  server.Signal(SIGINT);  // hurry
  EXPECT_EQ(server.Wait(), 0);
  std::istringstream lines(server.Log());
  bool found = false;
  for (std::string line; std::getline(lines, line);) {
    const auto json = base::ParseJson(line, "log line");
    ASSERT_TRUE(json.ok()) << line;
    found |= (*json)["event"] == "request" && (*json)["code"] == "INVALID_ARGUMENT" &&
             (*json)["request_id"].get<std::string>().size() == 16;
  }
  EXPECT_TRUE(found) << server.Log();
}

}  // namespace
}  // namespace poise::server
