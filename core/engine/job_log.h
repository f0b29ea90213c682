#ifndef POISE_CORE_ENGINE_JOB_LOG_H_
#define POISE_CORE_ENGINE_JOB_LOG_H_

#include <string_view>

#include "core/runtime/jobs/job_store.h"

namespace poise::engine {

/// Who wants to read what happens to jobs; declared here as an interface that does nothing, so that
/// the engine can tell without knowing how logs are written.
/// Threads: all members may be called from any thread, and must be quick.
class JobLog {
 public:
  virtual ~JobLog() = default;
  /// After the commit, in the order of commits.
  virtual void OnTransition(const jobs::Transition& /*transition*/) {}
  /// A task in the background failed: "reap", "collect", ... It will be tried again.
  virtual void OnTaskFailed(std::string_view /*task*/, const Status& /*status*/) {}

  /// The one that does nothing.
  static JobLog& None();
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_JOB_LOG_H_
