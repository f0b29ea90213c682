#include "core/runtime/jobs/sqlite_fence.h"

namespace poise::jobs::sqlite {

std::string_view FenceCondition() {
  return "job = (SELECT number FROM jobs WHERE id = ?1) AND attempt = ?2 AND token_hash = ?3";
}

}  // namespace poise::jobs::sqlite
