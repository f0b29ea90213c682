#include "core/base/isa.h"

#include <gtest/gtest.h>

#include <string>

namespace poise::base {
namespace {

int LevelV2() { return 2; }
int LevelV3() { return 3; }
int LevelV4() { return 4; }

TEST(IsaTest, SelectsTheBuildThatTheCpuCanRun) {
  const int level = SelectKernel(LevelV2, LevelV3, LevelV4)();
  EXPECT_EQ(std::string(IsaName(BestIsa())), "x86-64-v" + std::to_string(level));
  if (level >= 3) {
    EXPECT_TRUE(__builtin_cpu_supports("avx2"));
  }
  if (level >= 4) {
    EXPECT_TRUE(__builtin_cpu_supports("avx512f"));
  }
}

}  // namespace
}  // namespace poise::base
