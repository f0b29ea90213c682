#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/tensor_file.h"
#include "core/motion/dataset/clip_folder.h"
#include "core/motion/dataset/clip_set_file.h"
#include "tests/support/data_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// The largest distance between two clips' numbers [m or 1].
double Difference(const Clip& a, const Clip& b) {
  double largest = 0;
  for (int t = 0; t < a.num_frames(); ++t) {
    largest = std::max(largest, (a.root_position(t) - b.root_position(t)).norm());
    for (int j = 0; j < a.num_joints(); ++j) {
      largest = std::max(largest, a.rotation(t, j).angularDistance(b.rotation(t, j)));
    }
  }
  return largest;
}

ClipSet MadeSet() {
  ClipSet set{.clips = {}, .license = "mine", .notes = {"made up"}};
  set.clips.push_back({"kickLFront1Reps", "bd", testing::SwingingClip(5, 120)});
  set.clips.push_back({"kickRFront1Reps", "tr", testing::SwingingClip(7, 30, 0.3, 2)});
  return set;
}

TEST(ClipSetFileTest, ClipsComeBackToSinglePrecisionAndLabelsAsTheyWere) {
  const std::string bytes = EncodeClipSet(MadeSet());
  const auto set = DecodeClipSet(bytes, "set");
  ASSERT_TRUE(set.ok()) << set.status();
  ASSERT_EQ(set->clips.size(), 2u);
  EXPECT_EQ(set->license, "mine");
  EXPECT_EQ(set->notes, MadeSet().notes);
  EXPECT_EQ(set->clips[1].actor, "tr");
  EXPECT_EQ(set->clips[1].action, "kickRFront1Reps");
  EXPECT_EQ(set->clips[1].clip.frame_rate(), 30);
  for (size_t i = 0; i < 2; ++i) {
    const Clip expected = MadeSet().clips[i].clip;
    EXPECT_TRUE(set->clips[i].clip.skeleton()->SameAs(*expected.skeleton(), 0));
    EXPECT_LT(Difference(set->clips[i].clip, expected), 1e-6);
  }
  EXPECT_EQ(EncodeClipSet(MadeSet()), bytes);
}

TEST(ClipSetFileTest, FilesThatAreNoSetsAreRefused) {
  EXPECT_EQ(base::ErrorReason(DecodeClipSet(base::EncodeTensors({}), "set").status()),
            "MALFORMED_CLIP_SET");
  auto file = base::DecodeTensors(EncodeClipSet(MadeSet()), "set");
  ASSERT_TRUE(file.ok());
  base::TensorFile missing = *file;
  missing.tensors.erase("rotations/00001");
  EXPECT_EQ(base::ErrorReason(DecodeClipSet(base::EncodeTensors(missing), "set").status()),
            "MISSING_TENSOR");
  base::TensorFile spoilt = *file;
  spoilt.tensors["rotations/00000"].bytes.assign(5 * 21 * 16, '\0');
  EXPECT_EQ(base::ErrorReason(DecodeClipSet(base::EncodeTensors(spoilt), "set").status()),
            "NOT_A_ROTATION");
  for (const char* text : {"[]", "{}", R"({"license":"","notes":[],"skeletons":[],"clips":[]})"}) {
    base::TensorFile other = *file;
    other.metadata["clip_set"] = text;
    EXPECT_EQ(base::ErrorReason(DecodeClipSet(base::EncodeTensors(other), "set").status()),
              "MALFORMED_CLIP_SET")
        << text;
  }
}

TEST(LabelledClipTest, NamesOfHdm05TellActorAndAction) {
  const ClipLabels labels = LabelsOf("HDM_bd_kickLFront1Reps_003_120");
  EXPECT_EQ(labels.actor, "bd");
  EXPECT_EQ(labels.action, "kickLFront1Reps");
  EXPECT_EQ(LabelsOf("walking_1").action, "");
}

TEST(LabelledClipTest, AClassIsTheBeginningOfAnActionUpToACapitalOrADigit) {
  EXPECT_TRUE(IsOfClass("kickLFront1Reps", "kick"));
  EXPECT_TRUE(IsOfClass("walk4StepsLstart", "walk"));
  EXPECT_TRUE(IsOfClass("kick", "kick"));
  EXPECT_FALSE(IsOfClass("kickoff", "kick"));
  EXPECT_FALSE(IsOfClass("jumpDown", "kick"));
  EXPECT_FALSE(IsOfClass("kick", ""));
}

TEST(ClipFolderTest, FoldersNameActionsAndABrokenFileIsNamed) {
  const testing::TemporaryFolder folder;
  fs::create_directories(folder.path() / "wave");
  ASSERT_TRUE(WriteBvhFile(folder.path() / "wave/b.bvh", testing::SwingingClip(4)).ok());
  ASSERT_TRUE(WriteBvhFile(folder.path() / "wave/a.BVH", testing::SwingingClip(3)).ok());
  std::ofstream(folder.path() / "readme.md") << "no motion";
  const auto set = ReadClipFolder(folder.path(), {.license = "mine"});
  ASSERT_TRUE(set.ok()) << set.status();
  ASSERT_EQ(set->clips.size(), 2u);
  EXPECT_EQ(set->clips[0].clip.num_frames(), 3);
  EXPECT_EQ(set->clips[0].action, "wave");
  EXPECT_EQ(base::ErrorReason(ReadClipFolder(folder.path(), {.action_class = "kick"}).status()),
            "NO_CLIPS");
  EXPECT_EQ(base::ErrorReason(ReadClipFolder(folder.path() / "none", {}).status()),
            "FOLDER_NOT_FOUND");
  std::ofstream(folder.path() / "wave/c.bvh") << "HIERARCHY\nnonsense";
  const auto broken = ReadClipFolder(folder.path(), {});
  EXPECT_EQ(base::ErrorReason(broken.status()), "MALFORMED_BVH");
  EXPECT_THAT(base::Message(broken.status()), HasSubstr("wave/c.bvh"));
}

TEST(ClipFolderTest, Hdm05KicksAreReadAndRetargetedToOneBody) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  const auto files = testing::DataFiles("hdm05/kickLFront1Reps", {".amc"});
  const auto own = ReadClipFolder(testing::DataPath("hdm05"), {.action_class = "kick"});
  ASSERT_TRUE(own.ok()) << own.status();
  EXPECT_EQ(own->clips.size(), files.size());
  const auto one = ReadClipFolder(testing::DataPath("hdm05"),
                                  {.action_class = "kick", .retarget_to = files.front()});
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_THAT(one->notes, ::testing::ElementsAre(HasSubstr("HDM_bd_kickLFront1Reps_001_120.amc")));
  const SkeletonPtr body = one->clips.front().clip.skeleton();
  bool some_differ = false;
  for (size_t i = 0; i < one->clips.size(); ++i) {
    EXPECT_TRUE(one->clips[i].clip.skeleton()->SameAs(*body));
    EXPECT_EQ(one->clips[i].clip.num_frames(), own->clips[i].clip.num_frames());
    some_differ |= !own->clips[i].clip.skeleton()->SameAs(*body);
  }
  EXPECT_TRUE(some_differ);
  const auto decoded = DecodeClipSet(EncodeClipSet(*one), "set");
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  EXPECT_LT(Difference(decoded->clips.back().clip, one->clips.back().clip), 1e-5);
}

}  // namespace
}  // namespace poise::motion
