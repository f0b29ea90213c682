#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "core/runtime/jobs/sqlite_job_store.h"
#include "poise/v1/admin_service.grpc.pb.h"
#include "proto/convert/status_convert.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

namespace fs = std::filesystem;
using testing::FakeWorker;
using testing::JobClient;
using testing::SelftestRequest;
using testing::TestServer;
using Finding = v1::DiagnoseResponse::Finding;

StatusOr<v1::DiagnoseResponse> Diagnose(const TestServer& server) {
  grpc::ClientContext context;
  v1::DiagnoseResponse response;
  const grpc::Status status =
      v1::AdminService::NewStub(server.channel())->Diagnose(&context, {}, &response);
  if (!status.ok()) return convert::FromGrpc(status);
  return response;
}

StatusOr<v1::BackUpStoreResponse> BackUp(const TestServer& server, const std::string& path) {
  grpc::ClientContext context;
  v1::BackUpStoreRequest request;
  request.set_path(path);
  v1::BackUpStoreResponse response;
  const grpc::Status status =
      v1::AdminService::NewStub(server.channel())->BackUpStore(&context, request, &response);
  if (!status.ok()) return convert::FromGrpc(status);
  return response;
}

std::map<std::string, Finding::Severity> WorstByCheck(const v1::DiagnoseResponse& response) {
  std::map<std::string, Finding::Severity> worst;
  for (const Finding& finding : response.findings()) {
    worst[finding.check()] = std::max(worst[finding.check()], finding.severity());
  }
  return worst;
}

// A job that SUCCEEDED with one file; the artifact's name.
std::string JobWithResult(TestServer& server) {
  EXPECT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker worker(server.channel());
  v1::FinishJobRequest finish;
  const std::string artifact = server.engine().artifacts().Put("a result")->name;
  finish.add_artifacts()->set_name("a.txt");
  finish.mutable_artifacts(0)->set_artifact(artifact);
  EXPECT_TRUE(worker.Finish(worker.MustLease(), finish).ok());
  return artifact;
}

fs::path FileOf(const TestServer& server, const std::string& artifact) {
  const std::string digest = artifact.substr(artifact.find('/') + 1);
  return server.folder() / "artifacts" / digest.substr(0, 2) / digest;
}

TEST(AdminServiceTest, SoundServerHasNoFaults) {
  TestServer server;
  JobWithResult(server);
  const auto response = Diagnose(server);
  ASSERT_TRUE(response.ok()) << response.status();
  const auto worst = WorstByCheck(*response);
  for (const char* check : {"integrity", "counts", "leases", "events", "artifacts", "wal"}) {
    ASSERT_TRUE(worst.contains(check)) << check;
    EXPECT_EQ(worst.at(check), Finding::OK) << check;
  }
}

TEST(AdminServiceTest, DamagedOrMissingArtifactIsAFault) {
  TestServer server;
  const fs::path file = FileOf(server, JobWithResult(server));
  fs::permissions(file, fs::perms::owner_all);
  std::ofstream(file) << "b result";
  EXPECT_EQ(WorstByCheck(*Diagnose(server)).at("artifacts"), Finding::FAULT);
  fs::remove(file);
  EXPECT_EQ(WorstByCheck(*Diagnose(server)).at("artifacts"), Finding::FAULT);
}

TEST(AdminServiceTest, BackupIsAStoreWithTheJobs) {
  TestServer server;
  JobWithResult(server);
  const auto response = BackUp(server, "backups/monday.db");
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(fs::path(response->path()), fs::canonical(server.folder()) / "backups/monday.db");
  EXPECT_EQ(response->size_bytes(), static_cast<int64_t>(fs::file_size(response->path())));
  const auto store = jobs::OpenSqliteJobStore({.path = response->path(), .policy = {}});
  ASSERT_TRUE(store.ok()) << store.status();
  EXPECT_EQ((*store)->List({})->jobs.size(), 1u);
  EXPECT_EQ(base::ErrorReason(BackUp(server, "backups/monday.db").status()), "FILE_EXISTS");
}

TEST(AdminServiceTest, BackupStaysBelowTheDataFolder) {
  TestServer server;
  testing::TemporaryFolder elsewhere;
  fs::create_directory_symlink(elsewhere.path(), server.folder() / "link");
  for (const char* path : {"", "/tmp/x.db", "../x.db", "a/../../x.db", "./x.db", "link/x.db",
                           "link/deeper/x.db", "jobs.db", "jobs.db-wal", "artifacts/ab/x.db"}) {
    const Status status = BackUp(server, path).status();
    EXPECT_EQ(base::ErrorReason(status), "BAD_BACKUP_PATH") << path << ": " << status;
    EXPECT_EQ(base::ErrorField(status), "path");
  }
  EXPECT_TRUE(fs::is_empty(elsewhere.path()));
}

}  // namespace
}  // namespace poise::server
