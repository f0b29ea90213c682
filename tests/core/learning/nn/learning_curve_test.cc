#include "core/learning/nn/learning_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace poise::learning {
namespace {

LearningCurve MadeCurve() {
  LearningCurve curve;
  curve.Add({10, {{"net.loss", 1.0 / 3}, {"net.kl", 4e-310}}});
  curve.Add({20, {{"validation", -0.25}}});
  curve.Add({30, {{"net.loss", 1e-3}, {"net.kl", 2}}});
  return curve;
}

TEST(LearningCurveTest, CsvHasAColumnPerNameAndGapsWhereNothingWasMeasured) {
  LearningCurve curve;
  curve.Add({10, {{"loss", 0.5}}});
  curve.Add({20, {{"validation", 2}}});
  EXPECT_EQ(curve.ToCsv(), "step,loss,validation\n10,0.5,\n20,,2\n");
}

TEST(LearningCurveTest, CsvKeepsEveryBitOfANumber) {
  const auto again = LearningCurve::FromCsv(MadeCurve().ToCsv());
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(again->rows(), MadeCurve().rows());
  EXPECT_TRUE(LearningCurve::FromCsv(LearningCurve().ToCsv())->rows().empty());
}

TEST(LearningCurveTest, NamesTheLineThatIsNoRow) {
  for (const char* csv :
       {"step,loss\n10,0.5\n20\n", "step,loss\n10,0.5\nx,1\n", "step,loss\n10,0.5\n20,many\n"}) {
    const auto curve = LearningCurve::FromCsv(csv);
    EXPECT_EQ(base::ErrorReason(curve.status()), "MALFORMED_CURVE");
    EXPECT_THAT(base::Message(curve.status()), testing::HasSubstr("line 3"));
  }
}

TEST(LearningCurveTest, SvgPutsTheSmallestValueAtTheBottomAndDecadesAtEqualDistance) {
  LearningCurve curve;
  curve.Add({0, {{"loss", 100}}});
  curve.Add({1, {{"loss", 10}}});
  curve.Add({2, {{"loss", 1}}});
  // One chart of 420 x 200 below a title of 30: left 64, right 12, top 26, bottom 24.
  EXPECT_THAT(
      curve.ToSvg("a <b>"),
      testing::AllOf(testing::HasSubstr("points=\"64.0,56.0 236.0,131.0 408.0,206.0 \""),
                     testing::HasSubstr("a &lt;b>"), testing::HasSubstr("loss (log): last 1<")));
}

}  // namespace
}  // namespace poise::learning
