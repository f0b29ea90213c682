#include "samples/draw/figure_sheet.h"

#include <gtest/gtest.h>

#include <string_view>

#include "samples/author/samples.h"

namespace poise::samples {
namespace {

int Count(std::string_view text, std::string_view part) {
  int count = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::vector<motion::Clip> Clips() { return {*Perform(Kick()), *Perform(Walk())}; }

TEST(FigureSheetTest, DrawsEveryMomentOfEveryClip) {
  const auto svg = DrawSheet(Clips(), {.moments = 5});
  ASSERT_TRUE(svg.ok());
  EXPECT_EQ(Count(*svg, "<g "), 10);
  EXPECT_EQ(Count(*svg, "<g "), Count(*svg, "</g>"));
  EXPECT_EQ(Count(*svg, " s</text>"), 10);
  EXPECT_NE(svg->find(">walk 0.00 s<"), std::string::npos);
}

TEST(FigureSheetTest, OverlayPutsAllClipsIntoOneRow) {
  const auto svg = DrawSheet(Clips(), {.moments = 5, .overlay = true});
  ASSERT_TRUE(svg.ok());
  EXPECT_EQ(Count(*svg, "<g "), 10);
  EXPECT_EQ(Count(*svg, " s</text>"), 5);
  EXPECT_NE(svg->find("viewBox='0 0 725 195'"), std::string::npos);
}

TEST(FigureSheetTest, RefusesNothingToDrawAndBodiesWithoutRoles) {
  EXPECT_EQ(base::ErrorReason(DrawSheet({}, {}).status()), "EMPTY_SHEET");
  EXPECT_EQ(base::ErrorReason(DrawSheet(Clips(), {.moments = 0}).status()), "EMPTY_SHEET");
  const auto stick = *motion::Skeleton::Create({{"stick", -1, motion::Vec3::Zero(), {}}});
  const auto clip =
      *motion::Clip::Create("stick", stick, 60, {motion::Vec3::Zero()}, {motion::Quat::Identity()});
  EXPECT_EQ(base::ErrorReason(DrawSheet({clip}, {}).status()), "MISSING_ROLES");
}

}  // namespace
}  // namespace poise::samples
