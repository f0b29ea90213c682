#include "client/cli/push_input.h"

#include <gmock/gmock.h>

#include <fstream>
#include <map>

#include "tests/support/temporary_folder.h"

namespace poise::cli {
namespace {

TEST(PushInputTest, ALineStartsAtTheRear) {
  const auto places = FormationPlaces("line:10");
  ASSERT_TRUE(places.ok()) << places.status();
  ASSERT_EQ(places->size(), 10u);
  EXPECT_DOUBLE_EQ((*places)[9].x(), 9 * 0.35);
  EXPECT_DOUBLE_EQ((*FormationPlaces("line:3:0.5"))[2].x(), 1.0);
}

TEST(PushInputTest, ADiamondHasRowsOfOddNumbers) {
  const auto places = FormationPlaces("diamond:13");
  ASSERT_TRUE(places.ok()) << places.status();
  std::map<double, int> rows;
  for (const motion::Vec3& place : *places) ++rows[place.x()];
  std::vector<int> counts;
  for (const auto& [x, count] : rows) counts.push_back(count);
  EXPECT_THAT(counts, ::testing::ElementsAre(1, 3, 5, 3, 1));
  EXPECT_DOUBLE_EQ((*places)[0].x(), 0);
}

TEST(PushInputTest, OtherFormationsAreRefused) {
  for (const char* text : {"", "line", "line:", "line:0", "line:1001", "line:x", "diamond:12",
                           "circle:4", "line:3:x", "line:3:"}) {
    const auto places = FormationPlaces(text);
    EXPECT_EQ(base::ErrorReason(places.status()), "BAD_FORMATION") << text;
  }
}

TEST(PushInputTest, PushesSayWhoHowHardWhereToAndWhen) {
  const auto push = ParsePush("2:40Ns:90@0.5");
  ASSERT_TRUE(push.ok()) << push.status();
  EXPECT_EQ(push->person, 2);
  EXPECT_DOUBLE_EQ(push->start_s, 0.5);
  EXPECT_NEAR(push->impulse_ns.x(), 0, 1e-12);
  EXPECT_NEAR(push->impulse_ns.z(), -40, 1e-12);  // left of +X is -z
  const double weak = ParsePush("0:weak")->impulse_ns.x();
  const double medium = ParsePush("0:medium")->impulse_ns.x();
  EXPECT_LT(weak, medium);
  EXPECT_LT(medium, ParsePush("0:strong")->impulse_ns.x());
}

TEST(PushInputTest, MalformedPushesAreRefused) {
  for (const char* text :
       {"", "0", "0:", ":strong", "0:hard", "0:40", "0:strong:left", "0:strong@", "a:strong"}) {
    EXPECT_EQ(base::ErrorReason(ParsePush(text).status()), "BAD_PUSH") << text;
  }
}

TEST(PushInputTest, ASceneFileHoldsPeopleAndPushes) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "scene.json").string();
  std::ofstream(path) << R"({"duration_s": 3, "people": [{"id": "anna", "mass_kg": 60},
      {"place": [0.4, 0.1]}], "pushes": ["0:weak", {"person": 1, "impulse_ns": [10, -5]}]})";
  const auto spec = ReadSceneFile(path);
  ASSERT_TRUE(spec.ok()) << spec.status();
  EXPECT_DOUBLE_EQ(spec->duration_s, 3);
  EXPECT_EQ(spec->people[0].id, "anna");
  EXPECT_DOUBLE_EQ(spec->people[1].place->z(), 0.1);
  ASSERT_EQ(spec->pushes.size(), 2u);
  EXPECT_DOUBLE_EQ(spec->pushes[1].impulse_ns.z(), -5);
}

TEST(PushInputTest, BrokenSceneFilesAreExplained) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "scene.json").string();
  EXPECT_EQ(ReadSceneFile(path).status().code(), absl::StatusCode::kNotFound);
  std::ofstream(path) << R"({"people": [{"mass_kg": "heavy"}]})";
  EXPECT_EQ(base::ErrorReason(ReadSceneFile(path).status()), "MALFORMED_SCENE");
  std::ofstream(path, std::ios::trunc) << "{";
  EXPECT_EQ(base::ErrorReason(ReadSceneFile(path).status()), "MALFORMED_JSON");
}

}  // namespace
}  // namespace poise::cli
