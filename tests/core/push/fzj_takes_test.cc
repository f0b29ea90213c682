#include "core/push/takes/fzj_takes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "core/push/takes/csv_table.h"
#include "core/push/takes/onset.h"
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

}  // namespace
}  // namespace poise::push
