#include "client/artifact_transfer.h"

#include <gmock/gmock.h>

#include <fstream>

#include "client/client.h"
#include "core/base/sha256.h"
#include "tests/client/fake_jobs.h"
#include "tests/support/temporary_folder.h"

namespace poise::client {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int64_t kMiB = 1 << 20;

class ArtifactTransferTest : public ::testing::Test {
 protected:
  ArtifactTransferTest() : server_(jobs_, artifacts_) {
    ClientOptions options;
    options.server = server_.address;
    client_ = *Client::Connect(options);
    for (unsigned i = 0; i < 3 * kMiB; ++i) data_ += static_cast<char>(i * i >> 8);
  }

  std::string WriteFile(const std::string& data) const {
    const std::string path = folder_.path() / "file";
    std::ofstream(path, std::ios::binary) << data;
    return path;
  }
  std::string Read(const std::filesystem::path& path) const {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }

  poise::testing::TemporaryFolder folder_;
  std::string data_;
  testing::FakeJobs jobs_;
  testing::FakeArtifacts artifacts_;
  testing::FakeServer server_;
  std::unique_ptr<Client> client_;
};

TEST_F(ArtifactTransferTest, AnUploadThatBreaksGoesOnWithWhatTheServerHas) {
  artifacts_.break_uploads_after = 3;
  const auto stored = client_->UploadFile(WriteFile(data_));
  ASSERT_TRUE(stored.ok()) << stored.status();
  EXPECT_EQ(stored->name, "artifacts/" + base::Sha256Hex(data_));
  EXPECT_THAT(artifacts_.offsets, ElementsAre(0, 3 * kMiB / 2));
  EXPECT_TRUE(artifacts_.contents[stored->name] == data_);
}

TEST_F(ArtifactTransferTest, WhatTheServerHasIsNotSent) {
  artifacts_.Put(data_);
  const auto stored = client_->Upload(data_);
  EXPECT_EQ(stored->size_bytes, 3 * kMiB);
  EXPECT_EQ(stored->sent_bytes, 0);
  EXPECT_THAT(artifacts_.offsets, IsEmpty());
}

TEST_F(ArtifactTransferTest, AShortUploadIsSentAgainAsAWhole) {
  artifacts_.break_uploads_after = 0;
  ASSERT_TRUE(client_->Upload("abc").ok());
  EXPECT_THAT(artifacts_.offsets, ElementsAre(0, 0));
}

TEST_F(ArtifactTransferTest, AServerThatForgotWhatItHadGetsTheFileAnewOnce) {
  artifacts_.break_uploads_after = 3;
  artifacts_.corrupt = true;
  const auto stored = client_->Upload(data_);
  ASSERT_TRUE(stored.ok()) << stored.status();
  EXPECT_THAT(artifacts_.offsets, ElementsAre(0, 3 * kMiB / 2, 0));
}

TEST_F(ArtifactTransferTest, AFileThatIsNotThereIsAClearError) {
  EXPECT_EQ(base::ErrorReason(client_->UploadFile("/nowhere").status()), "FILE_NOT_FOUND");
}

TEST_F(ArtifactTransferTest, ADownloadThatBreaksGoesOnAndHasTheRightDigest) {
  artifacts_.break_downloads_after = 7;
  const std::string name = artifacts_.Put(data_);
  const auto bytes = client_->Download(name);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_TRUE(*bytes == data_);
  EXPECT_THAT(artifacts_.offsets, SizeIs(5));
}

TEST_F(ArtifactTransferTest, APartOfAFileIsGoneOnWith) {
  const std::string name = artifacts_.Put(data_);
  const std::filesystem::path path = folder_.path() / "out";
  std::ofstream(path.string() + ".part", std::ios::binary) << data_.substr(0, kMiB);
  ASSERT_TRUE(client_->DownloadFile(name, path).ok());
  EXPECT_THAT(artifacts_.offsets, ElementsAre(kMiB));
  EXPECT_TRUE(Read(path) == data_);
}

TEST_F(ArtifactTransferTest, APartOfAnotherFileIsThrownAway) {
  const std::string name = artifacts_.Put(data_);
  const std::filesystem::path path = folder_.path() / "out";
  for (const int64_t size : {kMiB, 5 * kMiB}) {
    std::ofstream(path.string() + ".part", std::ios::binary) << std::string(size, 'x');
    ASSERT_TRUE(client_->DownloadFile(name, path).ok());
    EXPECT_TRUE(Read(path) == data_);
    std::filesystem::remove(path);
  }
}

TEST_F(ArtifactTransferTest, AFileAppearsOnlyWithTheRightDigest) {
  const std::string name = "artifacts/" + base::Sha256Hex("other");
  artifacts_.contents[name] = "what";
  const std::filesystem::path path = folder_.path() / "out";
  EXPECT_EQ(base::ErrorReason(client_->DownloadFile(name, path)), "CORRUPTED");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  EXPECT_EQ(base::ErrorReason(client_->DownloadFile(name, "/nowhere/out")), "CANNOT_WRITE");
}

}  // namespace
}  // namespace poise::client
