#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

#include "core/artifacts/artifact_store.h"
#include "core/base/fail_point.h"
#include "core/base/sha256.h"
#include "tests/support/temporary_folder.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

constexpr char kId[] = "0123456789abcdef";

class ResumedUploadTest : public ::testing::Test {
 protected:
  std::unique_ptr<ArtifactStore> Open(int64_t max_bytes = 1 << 30) {
    return *ArtifactStore::Create({.root = root_, .max_artifact_bytes = max_bytes});
  }
  bool HasPart() const { return fs::exists(root_ / "uploads" / kId); }

  poise::testing::TemporaryFolder folder_;
  const fs::path root_ = folder_.path() / "a";
};

TEST_F(ResumedUploadTest, WhatWasWrittenOutlivesTheStreamAndTheProcess) {
  {
    const auto store = Open();
    const auto writer = *store->ResumeWriter(kId, 0);
    ASSERT_TRUE(writer->Append("a").ok());
    EXPECT_EQ(*store->ReceivedBytes(kId), 1);
  }
  const auto store = Open();
  EXPECT_EQ(*store->ReceivedBytes(kId), 1);
  const auto writer = *store->ResumeWriter(kId, 1);
  ASSERT_TRUE(writer->Append("bc").ok());
  EXPECT_EQ(writer->Commit(base::Sha256Hex("abc"))->size_bytes, 3);
  EXPECT_EQ(*store->ReadAll("artifacts/" + base::Sha256Hex("abc"), 10), "abc");
  EXPECT_EQ(*store->ReceivedBytes(kId), 0);
  EXPECT_FALSE(HasPart());
}

TEST_F(ResumedUploadTest, BytesBehindTheOffsetAreWrittenAnew) {
  const auto store = Open();
  ASSERT_TRUE((*store->ResumeWriter(kId, 0))->Append("abXYZ").ok());
  const auto writer = *store->ResumeWriter(kId, 2);
  EXPECT_EQ(*store->ReceivedBytes(kId), 2);
  ASSERT_TRUE(writer->Append("c").ok());
  EXPECT_TRUE(writer->Commit(base::Sha256Hex("abc")).ok());
}

TEST_F(ResumedUploadTest, AnOffsetBehindWhatArrivedIsRefusedAndLeavesNothing) {
  const auto store = Open();
  EXPECT_EQ(base::ErrorReason(store->ResumeWriter(kId, 1).status()), "WRONG_OFFSET");
  EXPECT_EQ(base::ErrorReason(store->ResumeWriter(kId, -1).status()), "WRONG_OFFSET");
  EXPECT_FALSE(HasPart());
  ASSERT_TRUE((*store->ResumeWriter(kId, 0))->Append("ab").ok());
  const Status status = store->ResumeWriter(kId, 3).status();
  EXPECT_EQ(base::ErrorReason(status), "WRONG_OFFSET");
  EXPECT_NE(base::Message(status).find("2 bytes"), std::string::npos) << status;
}

TEST_F(ResumedUploadTest, IdsThatCouldBeGuessedOrLeaveTheFolderAreRefused) {
  const auto store = Open();
  for (const std::string id :
       {"", "short", "../../../../etc/passwd", "0123456789abcde/", "0123456789.abcdef",
        "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef0"}) {
    EXPECT_EQ(base::ErrorReason(store->ResumeWriter(id, 0).status()), "BAD_UPLOAD_ID") << id;
    EXPECT_EQ(base::ErrorReason(store->ReceivedBytes(id).status()), "BAD_UPLOAD_ID") << id;
  }
}

TEST_F(ResumedUploadTest, TheLaterOfTwoStreamsGoesOnAndTheOtherIsTold) {
  const auto store = Open();
  const auto first = *store->ResumeWriter(kId, 0);
  ASSERT_TRUE(first->Append("ab").ok());
  const auto second = *store->ResumeWriter(kId, 2);
  EXPECT_EQ(base::ErrorReason(first->Append("XX")), "UPLOAD_TAKEN_OVER");
  EXPECT_EQ(base::ErrorReason(first->Commit(base::Sha256Hex("ab")).status()), "UPLOAD_TAKEN_OVER");
  ASSERT_TRUE(second->Append("c").ok());
  EXPECT_TRUE(second->Commit(base::Sha256Hex("abc")).ok());
}

TEST_F(ResumedUploadTest, AStreamThatComesBackDuringTheCommitIsToldToAsk) {
  const auto store = Open();
  const auto first = *store->ResumeWriter(kId, 0);
  ASSERT_TRUE(first->Append("abc").ok());
  std::atomic<bool> holding = false;
  std::atomic<bool> release = false;
  base::SetFailPoint("artifacts.before_commit", [&] {
    holding = true;
    while (!release) std::this_thread::yield();
  });
  std::thread committer([&] { EXPECT_TRUE(first->Commit(base::Sha256Hex("abc")).ok()); });
  while (!holding) std::this_thread::yield();
  std::thread comer(
      [&] { EXPECT_EQ(base::ErrorReason(store->ResumeWriter(kId, 3).status()), "WRONG_OFFSET"); });
  release = true;
  committer.join();
  comer.join();
  base::SetFailPoint("artifacts.before_commit", nullptr);
  EXPECT_TRUE(store->Get("artifacts/" + base::Sha256Hex("abc")).ok());
}

// Threads that take the upload over from each other at random; whoever wins in the end writes a
// file that is right.
TEST_F(ResumedUploadTest, ManyStreamsOnOneUploadNeverMixTheirBytes) {
  const auto store = Open();
  std::string content(300'000, '\0');
  std::mt19937 random(1);
  for (char& byte : content) byte = static_cast<char>(random());
  const std::string digest = base::Sha256Hex(content);
  std::atomic<bool> done = false;
  const auto upload = [&](int seed) {
    std::mt19937 piece(seed);
    while (!done) {
      const int64_t offset = *store->ReceivedBytes(kId);
      auto writer = store->ResumeWriter(kId, offset);
      if (!writer.ok()) continue;
      int64_t sent = offset;
      Status status;
      while (status.ok() && sent < static_cast<int64_t>(content.size()) && piece() % 20 != 0) {
        const int64_t size = std::min<int64_t>(1 + piece() % 5000, content.size() - sent);
        status = (*writer)->Append(std::string_view(content).substr(sent, size));
        sent += size;
      }
      if (!status.ok() || sent < static_cast<int64_t>(content.size())) continue;
      const auto stored = (*writer)->Commit(digest);
      EXPECT_NE(base::ErrorReason(stored.status()), "WRONG_DIGEST");
      if (stored.ok()) done = true;
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(upload, i);
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(*store->ReadAll("artifacts/" + digest, 1 << 20) == content);
}

TEST_F(ResumedUploadTest, AWrongDigestOrAFileTooLargeLeavesNothing) {
  const auto store = Open(3);
  {
    const auto writer = *store->ResumeWriter(kId, 0);
    ASSERT_TRUE(writer->Append("abd").ok());
    EXPECT_EQ(base::ErrorReason(writer->Commit(base::Sha256Hex("abc")).status()), "WRONG_DIGEST");
  }
  EXPECT_FALSE(HasPart());
  const auto writer = *store->ResumeWriter(kId, 0);
  EXPECT_EQ(base::ErrorReason(writer->Append("abcd")), "TOO_LARGE");
  EXPECT_FALSE(HasPart());
}

}  // namespace
}  // namespace poise::artifacts
