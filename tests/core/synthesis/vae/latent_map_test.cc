#include "core/synthesis/vae/latent_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace poise::synthesis {
namespace {

using ::testing::HasSubstr;

TEST(LatentMapTest, ShowsEveryMotionWhereItLiesOnThePrincipalAxes) {
  // Along x, then y; z is the same for all.
  Eigen::MatrixXd training(4, 3), samples(1, 3);
  training << -2, 0, 7, 2, 0, 7, 0, 1, 7, 0, -1, 7;
  samples << 0, 0, 7;
  const std::string svg = LatentMap(training, {{0, 1}, {2, 3}}, samples);
  // 400 px for 4 units about the middle of 480 px.
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"40.0\" cy=\"240.0\" r=\"4.5\" fill=\"#1f6fb4\"/>"));
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"440.0\" cy=\"240.0\" r=\"4.5\" fill=\"#1f6fb4\"/>"));
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"240.0\" cy=\"140.0\" r=\"4.5\" fill=\"#d1495b\"/>"));
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"240.0\" cy=\"240.0\" r=\"2.5\""));
  EXPECT_THAT(svg, HasSubstr("4 training motions in 2 clusters, 1 samples"));
  EXPECT_THAT(svg, HasSubstr("100 % of the variance"));
}

TEST(LatentMapTest, MotionsInOnePlaceAreShownInTheMiddle) {
  const Eigen::MatrixXd zeros = Eigen::MatrixXd::Zero(2, 4);
  EXPECT_THAT(LatentMap(zeros, {{0, 1}}, zeros), HasSubstr("cx=\"240.0\" cy=\"240.0\" r=\"4.5\""));
}

}  // namespace
}  // namespace poise::synthesis
