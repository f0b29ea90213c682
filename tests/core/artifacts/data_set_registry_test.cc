#include "core/artifacts/data_set_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/dataset/clip_set_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_clips.h"

namespace poise::artifacts {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

class DataSetRegistryTest : public ::testing::Test {
 protected:
  DataSetRegistryTest() {
    store_ = *ArtifactStore::Create({.root = folder_.path() / "artifacts"});
    Open();
  }
  void Open() { registry_ = *DataSetRegistry::Open(folder_.path() / "data_sets", *store_); }

  std::string Store(uint64_t seed) {
    motion::ClipSet set{.clips = {}, .license = "mine", .notes = {"made up"}};
    set.clips.push_back({"kick", "bd", testing::SwingingClip(31, 30, 0.3, seed)});
    set.clips.push_back({"kick", "tr", testing::SwingingClip(61, 30, 0.3, seed)});
    return store_->Put(motion::EncodeClipSet(set))->name;
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<ArtifactStore> store_;
  std::unique_ptr<DataSetRegistry> registry_;
};

TEST_F(DataSetRegistryTest, ADataSetTellsWhatIsInItAlsoAfterARestart) {
  const std::string artifact = Store(1);
  const auto created = registry_->Create("kicks", artifact);
  ASSERT_TRUE(created.ok()) << created.status();
  EXPECT_EQ(created->clips, 2);
  EXPECT_EQ(created->frames, 92);
  EXPECT_DOUBLE_EQ(created->duration_s, 3);
  EXPECT_THAT(created->actions, ElementsAre(Pair("kick", 2)));
  EXPECT_THAT(created->actors, ElementsAre(Pair("bd", 1), Pair("tr", 1)));
  EXPECT_EQ(created->license, "mine");
  EXPECT_EQ("artifacts/" + created->fingerprint(), artifact);
  Open();
  EXPECT_EQ(*registry_->Get("kicks"), *created);
  EXPECT_THAT(registry_->List(), ElementsAre(*created));
}

TEST_F(DataSetRegistryTest, ANameKeepsItsClips) {
  const auto first = registry_->Create("kicks", Store(1));
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(*registry_->Create("kicks", Store(1)), *first);
  EXPECT_EQ(base::ErrorReason(registry_->Create("kicks", Store(2)).status()), "DATA_SET_EXISTS");
  ASSERT_TRUE(registry_->Delete("kicks").ok());
  EXPECT_TRUE(registry_->Create("kicks", Store(2)).ok());
}

TEST_F(DataSetRegistryTest, ItsClipsAreNamedToWhoeverCollectsArtifacts) {
  const std::string artifact = Store(1);
  ASSERT_TRUE(registry_->Create("kicks", artifact).ok());
  EXPECT_THAT(registry_->Artifacts(), ElementsAre(artifact));
  ASSERT_TRUE(registry_->Delete("kicks").ok());
  EXPECT_THAT(registry_->Artifacts(), ElementsAre());
}

TEST_F(DataSetRegistryTest, WhatIsNoSetOrNotThereIsRefused) {
  const std::string other = store_->Put("no clips")->name;
  const Status status = registry_->Create("kicks", other).status();
  EXPECT_EQ(base::ErrorReason(status), "MALFORMED_TENSORS");
  EXPECT_EQ(base::ErrorField(status), "artifact");
  const std::string nowhere = "artifacts/" + std::string(64, '0');
  EXPECT_EQ(base::ErrorReason(registry_->Create("kicks", nowhere).status()), "ARTIFACT_NOT_FOUND");
  EXPECT_EQ(base::ErrorReason(registry_->Create("../kicks", Store(1)).status()),
            "BAD_DATA_SET_NAME");
  EXPECT_EQ(base::ErrorReason(registry_->Get("kicks").status()), "DATA_SET_NOT_FOUND");
  EXPECT_EQ(base::ErrorReason(registry_->Delete("kicks")), "DATA_SET_NOT_FOUND");
}

}  // namespace
}  // namespace poise::artifacts
