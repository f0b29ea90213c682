#ifndef POISE_SERVER_WORKER_CHILD_ENVIRONMENT_H_
#define POISE_SERVER_WORKER_CHILD_ENVIRONMENT_H_

#include <string>
#include <vector>

namespace poise::worker {

/// The environment of a job's process: this one's, without the token, and with one thread for
/// LibTorch and its BLAS unless it says otherwise (results must not depend on the number of CPUs).
/// What LibTorch needs before it loads is in this process's own already (launch_environment.cc), so
/// the child does not start twice.
std::vector<std::string> ChildEnvironment();

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_CHILD_ENVIRONMENT_H_
