#include "core/engine/clip_catalog.h"

#include <gtest/gtest.h>

#include "absl/time/clock.h"
#include "core/motion/io/clip_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_clips.h"

namespace poise::engine {
namespace {

TEST(ClipCatalogTest, StoredFileThatIsUsedIsNotCollected) {
  testing::TemporaryFolder folder;
  const auto store = *artifacts::ArtifactStore::Create({.root = folder.path()});
  const std::string name = store->Put(motion::EncodeBvh(testing::SwingingClip(20)))->name;
  const absl::Time stored = absl::Now();
  absl::SleepFor(absl::Milliseconds(20));
  api::StoredClip stored_clip;
  stored_clip.artifact = name;
  stored_clip.name = "swing.bvh";
  api::ClipSource source{.clip = stored_clip, .joint_roles = {}};
  ASSERT_TRUE(ClipCatalog(*store).Resolve(std::move(source)).ok());
  EXPECT_EQ(store->Collect({}, stored + absl::Milliseconds(10)), 0);
  EXPECT_EQ(store->Collect({}, absl::Now() + absl::Seconds(1)), 1);
}

}  // namespace
}  // namespace poise::engine
