#include "core/runtime/jobs/sqlite_file.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <fstream>

#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

// Which files the store takes, and what it says of the others.
namespace poise::testing {
namespace {

namespace fs = std::filesystem;

class SqliteFileTest : public ::testing::Test {
 protected:
  fs::path file() const { return folder_.path() / "jobs.db"; }
  static StatusOr<std::unique_ptr<jobs::JobStore>> Open(const fs::path& path) {
    return jobs::OpenSqliteJobStore({.path = path});
  }
  // A store with jobs in it, closed.
  void MakeStore(int jobs) {
    const auto store = Open(file());
    ASSERT_TRUE(store.ok()) << store.status();
    for (int i = 0; i < jobs; ++i) {
      jobs::NewJob job;
      job.request.spec = {"selftest", {{"padding", std::string(1000, 'x')}}};
      ASSERT_TRUE((*store)->Submit(job).ok());
    }
  }
  void Sql(const char* statements) {
    SQLite::Database(file().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec(statements);
  }
  void ExpectCorrupt() {
    const Status status = Open(file()).status();
    EXPECT_EQ(ReasonOf(status), "STORE_CORRUPT") << status;
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
  }

  const TemporaryFolder folder_;
};

TEST_F(SqliteFileTest, IsMadeWithItsFolders) {
  EXPECT_TRUE(Open(folder_.path() / "a" / "b" / "jobs.db").ok());
  EXPECT_TRUE(fs::exists(folder_.path() / "a" / "b" / "jobs.db"));
}

TEST_F(SqliteFileTest, IsTakenOnceUnderAnyName) {
  const auto store = Open(file());
  ASSERT_TRUE(store.ok());
  fs::create_symlink(folder_.path(), folder_.path() / "link");
  fs::create_symlink(file(), folder_.path() / "other.db");
  EXPECT_EQ(ReasonOf(Open(file())), "STORE_IN_USE");
  EXPECT_EQ(ReasonOf(Open(folder_.path() / "link" / "jobs.db")), "STORE_IN_USE");
  EXPECT_EQ(ReasonOf(Open(folder_.path() / "other.db")), "STORE_IN_USE");
}

TEST_F(SqliteFileTest, IsFreeAgainWhenClosed) {
  EXPECT_TRUE(Open(file()).ok());
  EXPECT_TRUE(Open(file()).ok());
}

TEST_F(SqliteFileTest, IsNotOnANetworkFileSystem) {
  for (const int64_t type : {0x6969, 0x517b, 0x0bd00bd0, 0x01021997}) {
    EXPECT_TRUE(jobs::sqlite::IsNetworkFileSystem(type)) << std::hex << type;
  }
  EXPECT_TRUE(jobs::sqlite::IsNetworkFileSystem(0xff534d42)) << "CIFS";
  EXPECT_TRUE(jobs::sqlite::IsNetworkFileSystem(0xfe534d42)) << "SMB2";
  EXPECT_FALSE(jobs::sqlite::IsNetworkFileSystem(0xef53)) << "ext4";
  EXPECT_FALSE(jobs::sqlite::IsNetworkFileSystem(0x58465342)) << "XFS";
  EXPECT_FALSE(jobs::sqlite::IsNetworkFileSystem(0x01021994)) << "tmpfs";
}

TEST_F(SqliteFileTest, CannotLieBelowAFile) {
  std::ofstream(folder_.path() / "plain") << "x";
  const Status status = Open(folder_.path() / "plain" / "jobs.db").status();
  EXPECT_EQ(ReasonOf(status), "BAD_DATA_DIR") << status;
}

TEST_F(SqliteFileTest, OfANewerProgramIsLeftAlone) {
  MakeStore(1);
  Sql("UPDATE settings SET value = value + 1 WHERE name = 'schema_version'");
  const Status status = Open(file()).status();
  EXPECT_EQ(ReasonOf(status), "NEWER_SCHEMA") << status;
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  Sql("UPDATE settings SET value = value - 1 WHERE name = 'schema_version'");
  const auto store = Open(file());
  ASSERT_TRUE(store.ok()) << store.status();
  EXPECT_EQ((*store)->Stats()->submitted, 1);
}

TEST_F(SqliteFileTest, OfAnotherProgramIsLeftAlone) {
  Sql("CREATE TABLE theirs (x); INSERT INTO theirs VALUES (7)");
  ExpectCorrupt();
  SQLite::Database database(file().string(), SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt(), 1);
}

TEST_F(SqliteFileTest, ThatIsNoDatabaseIsDataLoss) {
  std::ofstream(file()) << std::string(10'000, 'x');
  ExpectCorrupt();
}

TEST_F(SqliteFileTest, ThatWasCutShortIsDataLoss) {
  MakeStore(200);
  fs::resize_file(file(), fs::file_size(file()) / 2);
  ExpectCorrupt();
}

TEST_F(SqliteFileTest, WithDamagedPagesIsDataLoss) {
  MakeStore(200);
  const auto size = static_cast<int64_t>(fs::file_size(file()));
  std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
  for (int64_t page = 2; page * 4096 < size; ++page) {
    stream.seekp(page * 4096);
    stream << std::string(100, '\x7f');
  }
  stream.close();
  ExpectCorrupt();
}

TEST_F(SqliteFileTest, WithADamagedHeaderIsDataLoss) {
  MakeStore(5);
  std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
  stream << std::string(50, '\0');
  stream.close();
  ExpectCorrupt();
}

TEST_F(SqliteFileTest, WithOneDamagedJobServesTheOthers) {
  MakeStore(2);
  Sql("UPDATE jobs SET limits = '{' WHERE number = 1");
  const auto store = Open(file());
  ASSERT_TRUE(store.ok()) << store.status();
  ASSERT_TRUE((*store)->UpsertWorker({.id = "w"}).ok());
  EXPECT_EQ((*store)->Claim({"w", "t"}).status().code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ((*store)->Stats()->submitted, 2);
}

}  // namespace
}  // namespace poise::testing
