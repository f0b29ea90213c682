#include "core/engine/job_log.h"

namespace poise::engine {

JobLog& JobLog::None() {
  static JobLog none;
  return none;
}

}  // namespace poise::engine
