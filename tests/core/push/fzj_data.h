#ifndef POISE_TESTS_CORE_PUSH_FZJ_DATA_H_
#define POISE_TESTS_CORE_PUSH_FZJ_DATA_H_

#include <vector>

#include "core/push/takes/push_take.h"
#include "tests/support/data_files.h"

/// The recorded takes, read once a test program. Only after POISE_REQUIRE_DATA("fzj_push").
namespace poise::push::testing {

const std::vector<PushTake>& SingleTakes();
const std::vector<PushTake>& MultiTakes();
/// The take of this group and index; ends the program when there is none.
const PushTake& TakeNamed(const std::string& group, int index);

}  // namespace poise::push::testing

#endif  // POISE_TESTS_CORE_PUSH_FZJ_DATA_H_
