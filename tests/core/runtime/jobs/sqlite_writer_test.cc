#include "core/runtime/jobs/sqlite_writer.h"

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <stdexcept>
#include <thread>

#include "absl/time/clock.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

// Calls share a transaction and a sync, and nothing else.
namespace poise::testing {
namespace {

using jobs::sqlite::Connection;
using jobs::sqlite::Transaction;

class SqliteWriterTest : public ::testing::Test {
 protected:
  SqliteWriterTest() {
    auto connection =
        std::make_unique<Connection>(folder_.path() / "a.db", Connection::Mode::kWrite);
    connection->Script("CREATE TABLE numbers (value INTEGER PRIMARY KEY) STRICT");
    writer_.emplace(std::move(connection), jobs::JobPolicy{}, &absl::Now, [](Connection&) {});
  }
  Status Insert(int value) {
    return writer_->Run([value](Transaction& t) {
      t.db.Run("INSERT INTO numbers VALUES (?)", value);
      return absl::OkStatus();
    });
  }
  int64_t Count() {
    Connection reader(folder_.path() / "a.db", Connection::Mode::kRead);
    return reader.Number("SELECT count(*) FROM numbers");
  }

  const TemporaryFolder folder_;
  std::optional<jobs::sqlite::Writer> writer_;
};

TEST_F(SqliteWriterTest, AFailedCallUndoesItsOwnWritesAndNobodyElses) {
  // The first call holds the writer until the others wait, so that they share a transaction.
  std::promise<void> go;
  std::vector<std::thread> callers;
  callers.emplace_back([&] {
    EXPECT_TRUE(writer_
                    ->Run([&](Transaction&) {
                      go.get_future().wait();
                      return absl::OkStatus();
                    })
                    .ok());
  });
  callers.emplace_back([&] { EXPECT_TRUE(Insert(1).ok()); });
  callers.emplace_back([&] {
    EXPECT_EQ(ReasonOf(writer_->Run([](Transaction& t) {
                t.db.Run("INSERT INTO numbers VALUES (100)");
                return base::NotFound("GONE", "", "it is gone");
              })),
              "GONE");
  });
  callers.emplace_back([&] {
    EXPECT_EQ(ReasonOf(writer_->Run([](Transaction& t) -> Status {
                t.db.Run("INSERT INTO numbers VALUES (101)");
                throw std::runtime_error("a fault");
              })),
              "INTERNAL");
  });
  callers.emplace_back([&] {
    EXPECT_EQ(ReasonOf(writer_->Run([](Transaction& t) {
                t.db.Run("INSERT INTO numbers VALUES (102)");
                t.db.Run("INSERT INTO numbers VALUES (102)");  // the same key again
                return absl::OkStatus();
              })),
              "INTERNAL");
  });
  callers.emplace_back([&] { EXPECT_TRUE(Insert(2).ok()); });
  // Long enough for the others to wait, mostly; what is expected holds in any case.
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  go.set_value();
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(Count(), 2);
  EXPECT_TRUE(Insert(100).ok()) << "nothing of it was left";
}

TEST_F(SqliteWriterTest, WhatWasAskedForIsDoneBeforeItEnds) {
  std::vector<std::thread> callers;
  std::atomic<int> done = 0;
  for (int i = 0; i < 50; ++i) {
    callers.emplace_back([&, i] { done += Insert(i).ok(); });
  }
  for (std::thread& caller : callers) caller.join();
  writer_.reset();
  EXPECT_EQ(done, 50);
  EXPECT_EQ(Count(), 50);
}

TEST_F(SqliteWriterTest, TheListenerHearsOfCommittedChangesOnly) {
  std::vector<std::string> heard;
  writer_->SetListener({.on_transition = nullptr,
                        .on_event = [&](const std::string& job) { heard.push_back(job); }});
  const auto tell = [&](const char* job, const Status& status) {
    return writer_->Run([=](Transaction& t) {
      t.jobs_with_news.push_back(job);
      return status;
    });
  };
  EXPECT_TRUE(tell("good", absl::OkStatus()).ok());
  EXPECT_FALSE(tell("bad", absl::AbortedError("no")).ok());
  EXPECT_TRUE(tell("better", absl::OkStatus()).ok());
  EXPECT_THAT(heard, ::testing::ElementsAre("good", "better"));
}

}  // namespace
}  // namespace poise::testing
