#include "core/artifacts/artifact_store.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/artifacts/artifact_name.h"
#include "tests/support/temporary_folder.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

// From FIPS 180-2, appendix B.1.
constexpr char kAbc[] =
    "artifacts/ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

class ArtifactStoreTest : public ::testing::Test {
 protected:
  std::unique_ptr<ArtifactStore> Open(int64_t max_bytes = 1000) {
    return *ArtifactStore::Create({.root = folder_.path() / "a", .max_artifact_bytes = max_bytes});
  }
  int Files() const {
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      files += entry.is_regular_file();
    }
    return files;
  }

  poise::testing::TemporaryFolder folder_;
};

TEST_F(ArtifactStoreTest, NameIsTheDigestOfTheContent) {
  const auto store = Open();
  const ArtifactInfo info = *store->Put("abc");
  EXPECT_EQ(info.name, kAbc);
  EXPECT_EQ(info.size_bytes, 3);
  EXPECT_EQ(*store->ReadAll(kAbc, 1000), "abc");
  EXPECT_EQ(store->Get(kAbc)->size_bytes, 3);
}

TEST_F(ArtifactStoreTest, PiecesMakeTheSameArtifactAndAreStoredOnce) {
  const auto store = Open();
  const auto writer = *store->NewWriter();
  ASSERT_TRUE(writer->Append("a").ok());
  ASSERT_TRUE(writer->Append("bc").ok());
  EXPECT_EQ(writer->Commit(std::string(kAbc).substr(10))->name, kAbc);
  EXPECT_EQ(store->Put("abc")->name, kAbc);
  EXPECT_EQ(Files(), 1);
}

TEST_F(ArtifactStoreTest, RangesAreReadFromAnyOffset) {
  const auto store = Open();
  const std::string name = store->Put("0123456789")->name;
  EXPECT_EQ(*store->Read(name, 0, 4), "0123");
  EXPECT_EQ(*store->Read(name, 7, 100), "789");
  EXPECT_EQ(*store->Read(name, 10, 100), "");
  EXPECT_EQ(base::ErrorReason(store->Read(name, 11, 1).status()), "BAD_OFFSET");
  EXPECT_EQ(base::ErrorReason(store->Read(name, -1, 1).status()), "BAD_OFFSET");
}

TEST_F(ArtifactStoreTest, NamesThatAreNoDigestNeverBecomePaths) {
  const auto store = Open();
  std::ofstream(folder_.path() / "secret") << "x";
  const std::string hex(64, 'a');
  for (const std::string& name :
       {std::string(), std::string("artifacts/"), std::string("artifacts/../../secret"),
        "artifacts/" + hex.substr(1), "artifacts/" + hex + "a", "ARTIFACTS/" + hex,
        "artifacts/" + std::string(64, 'A'), "artifacts/" + hex.substr(3) + "../",
        "artifacts/" + hex.substr(1) + std::string(1, '\0'), "/artifacts/" + hex}) {
    EXPECT_EQ(base::ErrorReason(store->ReadAll(name, 1000).status()), "BAD_ARTIFACT_NAME") << name;
  }
  EXPECT_EQ(base::ErrorReason(store->Get("artifacts/" + hex).status()), "ARTIFACT_NOT_FOUND");
}

TEST_F(ArtifactStoreTest, WrongDigestAndAbandonedWritersLeaveNothing) {
  const auto store = Open();
  {
    const auto writer = *store->NewWriter();
    ASSERT_TRUE(writer->Append("abc").ok());
    EXPECT_EQ(base::ErrorReason(writer->Commit(std::string(64, '0')).status()), "WRONG_DIGEST");
    const auto abandoned = *store->NewWriter();
    ASSERT_TRUE(abandoned->Append("x").ok());
  }
  EXPECT_EQ(Files(), 0);
}

TEST_F(ArtifactStoreTest, FilesAboveTheCapAreRefused) {
  const auto store = Open(10);
  const auto writer = *store->NewWriter();
  EXPECT_TRUE(writer->Append("0123456789").ok());
  EXPECT_EQ(base::ErrorReason(writer->Append("x")), "TOO_LARGE");
  const std::string name = store->Put("0123456789")->name;
  EXPECT_EQ(base::ErrorReason(store->ReadAll(name, 9).status()), "TOO_LARGE");
}

TEST_F(ArtifactStoreTest, RestartKeepsArtifactsAndClearsHalfWrittenOnes) {
  Open()->Put("abc").IgnoreError();
  std::ofstream(folder_.path() / "a" / "staging" / "upload-dead") << "half";
  const auto store = Open();
  EXPECT_EQ(Files(), 1);
  EXPECT_EQ(*store->ReadAll(kAbc, 10), "abc");
}

TEST_F(ArtifactStoreTest, ChangedContentIsNoticed) {
  const auto store = Open();
  const std::string name = store->Put("abc")->name;
  std::ofstream(folder_.path() / "a" / "ba" / name.substr(10)) << "abd";
  const Status status = store->ReadAll(name, 10).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(base::ErrorReason(status), "CORRUPT_ARTIFACT");
}

TEST_F(ArtifactStoreTest, FolderThatCannotBeMadeIsAClearError) {
  std::ofstream(folder_.path() / "file") << "x";
  const Status status = ArtifactStore::Create({.root = folder_.path() / "file" / "a"}).status();
  EXPECT_EQ(base::ErrorReason(status), "BAD_DATA_DIR");
  EXPECT_NE(base::Message(status).find("file/a"), std::string::npos) << status;
}

}  // namespace
}  // namespace poise::artifacts
