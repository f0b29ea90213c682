#include <gtest/gtest.h>

#include <fstream>

#include "absl/time/clock.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/sha256.h"
#include "tests/support/temporary_folder.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

constexpr char kOld[] = "0000000000000000old";
constexpr char kNew[] = "0000000000000000new";

class ArtifactCollectionTest : public ::testing::Test {
 protected:
  std::unique_ptr<ArtifactStore> Open() { return *ArtifactStore::Create({.root = root_}); }
  void Age(const fs::path& file, std::chrono::hours age) const {
    fs::last_write_time(root_ / file, fs::file_time_type::clock::now() - age);
  }
  fs::path FileOf(const std::string& name) const {
    return fs::path(name.substr(10, 2)) / name.substr(10);
  }

  poise::testing::TemporaryFolder folder_;
  const fs::path root_ = folder_.path() / "a";
};

TEST_F(ArtifactCollectionTest, OnlyOldArtifactsThatNobodyNeedsGo) {
  const auto store = Open();
  const std::string needed = store->Put("needed")->name;
  const std::string fresh = store->Put("fresh")->name;
  const std::string refreshed = store->Put("refreshed")->name;
  const std::string restored = store->Put("restored")->name;
  const std::string old = store->Put("old")->name;
  for (const std::string& name : {needed, refreshed, restored, old}) {
    Age(FileOf(name), std::chrono::hours(48));
  }
  ASSERT_TRUE(store->Refresh(refreshed).ok());
  ASSERT_TRUE(store->Put("restored").ok());
  EXPECT_EQ(store->Collect({needed}, absl::Now() - absl::Hours(24)), 1);
  EXPECT_EQ(base::ErrorReason(store->Get(old).status()), "ARTIFACT_NOT_FOUND");
  for (const std::string& name : {needed, fresh, refreshed, restored}) {
    EXPECT_TRUE(store->Get(name).ok()) << name;
  }
}

TEST_F(ArtifactCollectionTest, UploadsThatNobodyGoesOnWithGoAfterADay) {
  {
    const auto store = Open();
    ASSERT_TRUE((*store->ResumeWriter(kOld, 0))->Append("x").ok());
    ASSERT_TRUE((*store->ResumeWriter(kNew, 0))->Append("x").ok());
    Age(fs::path("uploads") / kOld, std::chrono::hours(25));
    Age(fs::path("uploads") / kNew, std::chrono::hours(23));
    EXPECT_EQ(store->CollectUploads(absl::Now()), 1);
    EXPECT_EQ(*store->ReceivedBytes(kOld), 0);
    EXPECT_EQ(*store->ReceivedBytes(kNew), 1);
    Age(fs::path("uploads") / kNew, std::chrono::hours(25));
  }
  EXPECT_EQ(*Open()->ReceivedBytes(kNew), 0) << "a start collects too";
}

TEST_F(ArtifactCollectionTest, AnUploadUnderWayStaysHoweverSlowItIs) {
  const auto store = Open();
  const auto writer = *store->ResumeWriter(kOld, 0);
  ASSERT_TRUE(writer->Append("abc").ok());
  Age(fs::path("uploads") / kOld, std::chrono::hours(25));
  EXPECT_EQ(store->CollectUploads(absl::Now()), 0);
  EXPECT_TRUE(writer->Commit(base::Sha256Hex("abc")).ok());
}

TEST_F(ArtifactCollectionTest, ResumingCollectsAtMostHourly) {
  const auto store = Open();
  ASSERT_TRUE((*store->ResumeWriter(kOld, 0))->Append("x").ok());
  Age(fs::path("uploads") / kOld, std::chrono::hours(25));
  ASSERT_TRUE(store->ResumeWriter(kNew, 0).ok());
  EXPECT_EQ(*store->ReceivedBytes(kOld), 1) << "the start has just looked";
  store->CollectUploads(absl::Now() - absl::Hours(30));  // as if that was the last time
  ASSERT_TRUE(store->ResumeWriter(kNew, 0).ok());
  EXPECT_EQ(*store->ReceivedBytes(kOld), 0);
}

}  // namespace
}  // namespace poise::artifacts
