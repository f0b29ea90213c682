#include "core/engine/backup_path.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace poise::engine {
namespace {

namespace fs = std::filesystem;

TEST(BackupPathTest, FoldersOnTheWayAreMade) {
  testing::TemporaryFolder folder;
  const auto path = BackUpPath(folder.path(), "backups/2026/monday.db");
  ASSERT_TRUE(path.ok()) << path.status();
  EXPECT_EQ(*path, fs::canonical(folder.path()) / "backups/2026/monday.db");
  EXPECT_TRUE(fs::is_directory(path->parent_path()));
  EXPECT_FALSE(fs::exists(*path));
}

TEST(BackupPathTest, NothingLeadsOutOfTheFolderOrIntoTheServersOwnFiles) {
  testing::TemporaryFolder folder, elsewhere;
  fs::create_directory(folder.path() / "artifacts");
  fs::create_directory_symlink(elsewhere.path(), folder.path() / "out");
  fs::create_directory_symlink(folder.path() / "artifacts", folder.path() / "in");
  for (const char* path : {"", "/etc/x", "..", "../x", "a/../../x", "a//..", ".", "./x", "x/",
                           "out/x", "in/x", "jobs.db", "jobs.db.lock", "artifacts/x"}) {
    EXPECT_EQ(base::ErrorReason(BackUpPath(folder.path(), path).status()), "BAD_BACKUP_PATH")
        << path;
  }
  EXPECT_EQ(base::ErrorReason(BackUpPath(folder.path(), std::string("a\0b", 3)).status()),
            "BAD_BACKUP_PATH");
  EXPECT_TRUE(fs::is_empty(elsewhere.path()));
}

}  // namespace
}  // namespace poise::engine
