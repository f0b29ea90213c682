#include "core/push/takes/fzj_takes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "core/base/tensor_file.h"
#include "core/push/takes/csv_table.h"
#include "core/push/takes/onset.h"
#include "core/push/takes/take_file.h"
#include "tests/core/push/fzj_data.h"

namespace poise::push {
namespace {

using poise::testing::DataPath;
using testing::MultiTakes;
using testing::SingleTakes;

int Frames(const std::vector<const PushTake*>& takes) {
  int frames = 0;
  for (const PushTake* take : takes) frames += take->frames;
  return frames;
}

TEST(FzjTakesTest, CountsAreThoseOfThePaper) {
  POISE_REQUIRE_DATA("fzj_push");
  EXPECT_EQ(SingleTakes().size(), 45u);
  EXPECT_EQ(MultiTakes().size(), 63u);
  EXPECT_EQ(TakesOf(SingleTakes(), Split::kTrain).size(), 32u);
  EXPECT_EQ(TakesOf(MultiTakes(), Split::kTrain).size(), 49u);
  EXPECT_EQ(Frames(TakesOf(SingleTakes(), Split::kTest)), 910);
  EXPECT_EQ(Frames(TakesOf(MultiTakes(), Split::kTest)), 1173);
  std::set<std::string> files;
  for (const PushTake& take : MultiTakes()) {
    for (const TakePerson& person : take.people) files.insert(person.file);
  }
  EXPECT_EQ(files.size(), 287u);
}

TEST(FzjTakesTest, ValidationTakesComeFromTrainingAndLeaveTheRest) {
  POISE_REQUIRE_DATA("fzj_push");
  for (const auto* takes : {&SingleTakes(), &MultiTakes()}) {
    const TrainingTakes split = SplitTraining(*takes);
    EXPECT_EQ(split.validation.size(), 8u);
    std::set<const PushTake*> all(split.train.begin(), split.train.end());
    all.insert(split.validation.begin(), split.validation.end());
    EXPECT_EQ(all.size(), split.train.size() + split.validation.size());
    const auto train = TakesOf(*takes, Split::kTrain);
    EXPECT_EQ(all, std::set<const PushTake*>(train.begin(), train.end()));
  }
}

TEST(FzjTakesTest, OnsetsFollowTheStatedRule) {
  POISE_REQUIRE_DATA("fzj_push");
  int moving = 0;
  for (const PushTake& take : MultiTakes()) {
    for (size_t i = 0; i < take.people.size(); ++i) {
      EXPECT_EQ(RecordedOnset(take.people[i], i == 0), take.people[i].stated_onset)
          << take.people[i].file;
      moving += take.split == Split::kTest && take.people[i].stated_onset >= 0;
    }
  }
  EXPECT_EQ(moving, 56);
}

TEST(FzjTakesTest, TheAuthorsTwoCorrectionsOfPushLengthsAreApplied) {
  POISE_REQUIRE_DATA("fzj_push");
  EXPECT_EQ(testing::TakeNamed("row_1", 6).push_frames, 15);
  EXPECT_EQ(testing::TakeNamed("row_2", 3).push_frames, 20);
}

TEST(FzjTakesTest, MissingFolderIsNotFound) {
  const auto takes = ReadSingleTakes("/nowhere");
  EXPECT_EQ(takes.status().code(), absl::StatusCode::kNotFound);
}

TEST(TakeFileTest, KeepsEveryNumberOfTheTakes) {
  POISE_REQUIRE_DATA("fzj_push");
  const std::vector<PushTake> takes = {testing::TakeNamed("X07", 11),
                                       testing::TakeNamed("row_1", 6)};
  const std::string bytes = EncodeTakes(takes);
  const auto read = DecodeTakes(bytes, "takes");
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->size(), takes.size());
  for (size_t i = 0; i < takes.size(); ++i) {
    const PushTake &was = takes[i], &is = (*read)[i];
    EXPECT_EQ(is.name(), was.name());
    EXPECT_EQ(is.split, was.split);
    EXPECT_EQ(is.multi, was.multi);
    EXPECT_EQ(is.session, was.session);
    EXPECT_EQ(is.frames, was.frames);
    EXPECT_EQ(is.force, was.force);
    EXPECT_EQ(is.push_frames, was.push_frames);
    ASSERT_EQ(is.people.size(), was.people.size());
    for (size_t person = 0; person < was.people.size(); ++person) {
      EXPECT_EQ(is.people[person].joints, was.people[person].joints);
      EXPECT_EQ(is.people[person].rotations, was.people[person].rotations);
      EXPECT_EQ(is.people[person].mass_kg, was.people[person].mass_kg);
      EXPECT_EQ(is.people[person].stated_onset, was.people[person].stated_onset);
    }
  }
}

TEST(TakeFileTest, RefusesWhatIsNone) {
  EXPECT_FALSE(DecodeTakes("no tensors", "takes").ok());
  base::TensorFile file;
  EXPECT_EQ(base::ErrorReason(DecodeTakes(base::EncodeTensors(file), "takes").status()),
            "MALFORMED_TAKE");
  file.metadata["takes"] = "[{\"group\": \"X05\"}]";
  EXPECT_EQ(base::ErrorReason(DecodeTakes(base::EncodeTensors(file), "takes").status()),
            "MALFORMED_TAKE");
}

}  // namespace
}  // namespace poise::push
