#include "tests/core/push/fzj_data.h"

#include <cstdlib>
#include <iostream>

#include "core/push/takes/fzj_takes.h"

namespace poise::push::testing {
namespace {

std::vector<PushTake> OrAbort(StatusOr<std::vector<PushTake>> takes) {
  if (takes.ok()) return *std::move(takes);
  std::cerr << takes.status() << "\n";
  std::abort();
}

}  // namespace

const std::vector<PushTake>& SingleTakes() {
  static const auto takes = OrAbort(ReadSingleTakes(poise::testing::DataPath("fzj_push")));
  return takes;
}

const std::vector<PushTake>& MultiTakes() {
  static const auto takes = OrAbort(ReadMultiTakes(poise::testing::DataPath("fzj_push")));
  return takes;
}

const PushTake& TakeNamed(const std::string& group, int index) {
  for (const auto* takes : {&SingleTakes(), &MultiTakes()}) {
    for (const PushTake& take : *takes) {
      if (take.group == group && take.index == index) return take;
    }
  }
  std::cerr << "no take " << group << " " << index << "\n";
  std::abort();
}

}  // namespace poise::push::testing
