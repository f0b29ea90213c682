// poise-learner (not for people): the process of one attempt that needs LibTorch, which
// poise-worker and its other children do not load.
#include <fmt/format.h>

#include <cstdio>
#include <cstring>

#include "core/base/fail_point.h"
#include "core/base/memory_policy.h"
#include "core/engine/learning_runners.h"
#include "core/runtime/jobs/child_side.h"

int main(int argc, char** argv) {
  poise::base::SetFailPointsFromEnvironment();
  poise::base::KeepFreedMemory();
  if (argc == 2 && std::strcmp(argv[1], "--child") == 0) {
    return poise::jobs::ServeChild(poise::engine::MakeRunner);
  }
  fmt::print(stderr, "poise-learner: poise-worker starts it for jobs that learn\n");
  return 2;
}
