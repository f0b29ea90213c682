#include "client/job_handle.h"

#include <gmock/gmock.h>

#include <fstream>
#include <thread>

#include "absl/time/clock.h"
#include "client/client.h"
#include "tests/client/fake_jobs.h"
#include "tests/support/temporary_folder.h"

// The client's job calls against a server of the test's own, over a real channel.
namespace poise::client {
namespace {

using api::JobState;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const grpc::Status kSocketClosed(grpc::StatusCode::UNAVAILABLE, "Socket closed");

class JobHandleTest : public ::testing::Test {
 protected:
  JobHandleTest() : server_(std::make_unique<testing::FakeServer>(jobs_, artifacts_)) {
    options_.server = server_->address;
    options_.outage = absl::Seconds(20);
  }

  Client& client() {
    if (client_ == nullptr) client_ = *Client::Connect(options_);
    return *client_;
  }

  // The states of all events, until the end.
  std::vector<JobState> States(JobWatch& watch) {
    std::vector<JobState> states;
    while (true) {
      const auto event = watch.Next();
      EXPECT_TRUE(event.ok()) << event.status();
      if (!event.ok() || !event->has_value()) return states;
      if ((*event)->state) states.push_back(*(*event)->state);
    }
  }

  testing::FakeJobs jobs_;
  testing::FakeArtifacts artifacts_;
  ClientOptions options_;
  std::unique_ptr<testing::FakeServer> server_;
  std::unique_ptr<Client> client_;
};

TEST_F(JobHandleTest, AJobIsCreatedOnceThoughItsAnswerWasLost) {
  options_.tenant = "lab";
  jobs_.lost_answers = {kSocketClosed, kSocketClosed};
  const auto job = client().CreateJob({.spec = {.kind = "selftest", .parameters = {{"steps", 3}}}});
  ASSERT_TRUE(job.ok()) << job.status();
  ASSERT_THAT(jobs_.creates, SizeIs(3));
  EXPECT_EQ(jobs_.creates[0].request_id().size(), 32u);
  EXPECT_EQ(jobs_.creates[2].request_id(), jobs_.creates[0].request_id());
  EXPECT_THAT(jobs_.tenants, ElementsAre("lab", "lab", "lab"));
  EXPECT_EQ(client().GetJob(job->id)->request_id, job->request_id);
}

TEST_F(JobHandleTest, TwoJobsWithoutARequestIdAreTwoJobs) {
  const auto first = client().CreateJob({.spec = {.kind = "selftest"}});
  const auto second = client().CreateJob({.spec = {.kind = "selftest"}});
  EXPECT_NE(first->id, second->id);
  const auto same =
      client().CreateJob({.spec = {.kind = "selftest"}, .request_id = first->request_id});
  EXPECT_EQ(same->id, first->id);
}

TEST_F(JobHandleTest, DeletingTwiceBecauseTheAnswerWasLostIsNoError) {
  const std::string id = jobs_.Add(JobState::kSucceeded);
  jobs_.lost_answers = {kSocketClosed};
  EXPECT_TRUE(client().DeleteJob(id).ok());
  EXPECT_EQ(base::ErrorReason(client().DeleteJob(id)), "JOB_NOT_FOUND");
}

TEST_F(JobHandleTest, WhatBreaksIsJoinedAgainAndEveryStateComesOnce) {
  const std::string id = jobs_.Add(JobState::kQueued);
  jobs_.SetState(id, JobState::kRunning);
  jobs_.SetProgress(id, 1, 2);
  jobs_.SetState(id, JobState::kSucceeded);
  // A break in each place, in each way in which a stream may end.
  jobs_.cuts = {{0, kSocketClosed},
                {1, grpc::Status::OK},
                {1, grpc::Status::CANCELLED},
                {1, grpc::Status(grpc::StatusCode::DEADLINE_EXCEEDED, "too long")}};
  const auto watch = client().WatchJob(id);
  EXPECT_THAT(States(*watch),
              ElementsAre(JobState::kQueued, JobState::kRunning, JobState::kSucceeded));
  EXPECT_THAT(jobs_.joins, ElementsAre(0, 0, 1, 2, 3));
  EXPECT_FALSE(watch->Next()->has_value()) << "the end stays the end";
  EXPECT_EQ(watch->job().state, JobState::kSucceeded);
}

TEST_F(JobHandleTest, AWatchBehindTheTerminalEventEndsAtOnce) {
  const std::string id = jobs_.Add(JobState::kQueued);
  jobs_.SetState(id, JobState::kCancelled);
  const auto watch = client().WatchJob(id, {.after_seq = 2});
  EXPECT_THAT(States(*watch), IsEmpty());
  EXPECT_EQ(watch->job().state, JobState::kCancelled);
}

TEST_F(JobHandleTest, AnUnknownJobIsNotJoinedAgain) {
  EXPECT_EQ(base::ErrorReason(client().WatchJob("nowhere")->Next().status()), "JOB_NOT_FOUND");
  EXPECT_THAT(jobs_.joins, SizeIs(1));
}

TEST_F(JobHandleTest, AServerThatRestartsIsNotNoticedByWhoWaits) {
  const std::string id = jobs_.Add(JobState::kRunning);
  StatusOr<api::Job> done;
  std::thread waiter([&] { done = client().Handle(id).Wait(); });
  while (jobs_.joins.empty()) absl::SleepFor(absl::Milliseconds(1));
  const std::string address = server_->address;
  server_.reset();
  absl::SleepFor(absl::Seconds(1));
  server_ = std::make_unique<testing::FakeServer>(jobs_, artifacts_, address);
  jobs_.SetState(id, JobState::kFailed, absl::StatusCode::kOutOfRange);
  waiter.join();
  ASSERT_TRUE(done.ok()) << done.status();
  EXPECT_EQ(done->state, JobState::kFailed);
  EXPECT_EQ(done->error->reason, "TOLD_TO");
  EXPECT_LE(jobs_.gets, 2) << "waiting is not polling";
}

TEST_F(JobHandleTest, AServerThatStaysAwayIsToldAfterTheOutage) {
  options_.outage = absl::Seconds(1);
  const std::string id = jobs_.Add(JobState::kRunning);
  const auto watch = client().WatchJob(id);
  ASSERT_TRUE(watch->Next().ok());
  server_.reset();
  EXPECT_EQ(watch->Next().status().code(), absl::StatusCode::kUnavailable);
  const auto job = client().GetJob(id);
  EXPECT_EQ(base::ErrorReason(job.status()), "NO_SERVER") << job.status();
}

TEST_F(JobHandleTest, WaitEndsWithItsDeadlineAndTheJobGoesOn) {
  const std::string id = jobs_.Add(JobState::kRunning);
  const auto done = client().Handle(id).Wait(absl::Now() + absl::Milliseconds(100));
  EXPECT_EQ(base::ErrorReason(done.status()), "DEADLINE_EXCEEDED");
  EXPECT_EQ(client().Handle(id).Get()->state, JobState::kRunning);
}

TEST_F(JobHandleTest, CancelEndsAWatchThatWaits) {
  const std::string id = jobs_.Add(JobState::kRunning);
  const auto watch = client().WatchJob(id);
  ASSERT_TRUE(watch->Next().ok());
  std::thread canceller([&] {
    absl::SleepFor(absl::Milliseconds(50));
    watch->Cancel();
  });
  EXPECT_EQ(watch->Next().status().code(), absl::StatusCode::kCancelled);
  canceller.join();
  EXPECT_EQ(watch->Next().status().code(), absl::StatusCode::kCancelled);
}

TEST_F(JobHandleTest, CancelEndsAWatchBetweenTwoTries) {
  options_.outage = absl::InfiniteDuration();
  const std::string id = jobs_.Add(JobState::kRunning);
  const auto watch = client().WatchJob(id);
  ASSERT_TRUE(watch->Next().ok());
  server_.reset();
  std::thread canceller([&] {
    absl::SleepFor(absl::Milliseconds(500));
    watch->Cancel();
  });
  EXPECT_EQ(watch->Next().status().code(), absl::StatusCode::kCancelled);
  canceller.join();
}

class JobResultTest : public JobHandleTest {
 protected:
  JobResultTest() : id_(jobs_.Add(JobState::kSucceeded)) {
    jobs_.SetArtifacts(id_, {{"manifest.json", artifacts_.Put("{}"), 2, "application/json"},
                             {"variants/0.bvh", artifacts_.Put(big_), 500'000, "text/plain"}});
  }

  std::string Saved(const std::string& name) const {
    std::ifstream file(folder_.path() / "out" / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }

  const std::string big_ = std::string(250'000, 'x') + std::string(250'000, 'y');
  poise::testing::TemporaryFolder folder_;
  std::string id_;
};

TEST_F(JobResultTest, TheResultComesIntoMemoryOrIntoFiles) {
  const auto files = client().Handle(id_).Result();
  ASSERT_TRUE(files.ok()) << files.status();
  ASSERT_THAT(*files, SizeIs(2));
  EXPECT_EQ((*files)[0].artifact.name, "manifest.json");
  EXPECT_TRUE((*files)[1].data == big_);
  ASSERT_TRUE(client().Handle(id_).SaveResult(folder_.path() / "out").ok());
  EXPECT_EQ(Saved("manifest.json"), "{}");
  EXPECT_TRUE(Saved("variants/0.bvh") == big_);
}

TEST_F(JobResultTest, AResultThatBreaksOffGoesOnAndIsNotFetchedTwice) {
  artifacts_.break_downloads_after = 2;
  ASSERT_TRUE(client().Handle(id_).SaveResult(folder_.path() / "out", "variants/0.bvh").ok());
  EXPECT_TRUE(Saved("variants/0.bvh") == big_);
  EXPECT_THAT(artifacts_.offsets, ElementsAre(0, 200'000, 400'000));
  ASSERT_TRUE(client().Handle(id_).SaveResult(folder_.path() / "out", "variants/0.bvh").ok());
  EXPECT_THAT(artifacts_.offsets, SizeIs(3));
}

TEST_F(JobResultTest, OnlyASucceededJobHasAResult) {
  const auto files = client().Handle(jobs_.Add(JobState::kRunning)).Result();
  EXPECT_EQ(base::ErrorReason(files.status()), "JOB_NOT_SUCCEEDED");
  EXPECT_EQ(base::ErrorReason(client().Handle(id_).SaveResult(folder_.path(), "x").status()),
            "RESULT_NOT_FOUND");
}

TEST_F(JobResultTest, NamesThatLeaveTheFolderAreRefused) {
  for (const char* name : {"../x", "a/../../x", "/tmp/x", "", "a/"}) {
    jobs_.SetArtifacts(id_, {{name, artifacts_.Put("{}"), 2, ""}});
    const Status status = client().Handle(id_).SaveResult(folder_.path() / "out").status();
    EXPECT_EQ(base::ErrorReason(status), "BAD_RESULT_NAME") << name;
  }
}

}  // namespace
}  // namespace poise::client
