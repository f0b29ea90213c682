#include <string>

#include "tests/core/runtime/jobs/race_scenarios.h"

namespace poise::testing {
namespace {

using api::JobState;

void FinishAfterReap(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto finish = stage.HeldFinish(stage.Claim("late").fence, Success());
  stage.ReapSilentWorkers();
  stage.PromiseLeaseLost(finish.LetGo().status(), "the late success");
  stage.PromiseState(id, JobState::kQueued);
}

void ReapAfterFinish(RaceStage& stage) {
  const std::string id = stage.Submit();
  const jobs::Fence fence = stage.Claim("late").fence;
  auto reap = stage.HeldReap();
  stage.Promise(stage.store().Finish(fence, Success()).ok(), "the success counts");
  stage.Promise(reap.LetGo().value_or(-1) == 0, "nothing is left to reap");
  stage.ReapSilentWorkers();
  stage.PromiseState(id, JobState::kSucceeded);
}

void CancelAfterFinish(RaceStage& stage) {
  const std::string id = stage.Submit();
  const jobs::Fence fence = stage.Claim("worker").fence;
  auto cancel = stage.HeldCancel(id);
  stage.Promise(stage.store().Finish(fence, Success()).ok(), "the success counts");
  stage.Promise(cancel.LetGo().ok(), "the wish is answered");
  stage.PromiseState(id, JobState::kSucceeded);
}

void FinishAfterCancel(RaceStage& stage) {
  for (const bool success : {true, false}) {
    const std::string id = stage.Submit();
    auto finish = stage.HeldFinish(stage.Claim("worker").fence,
                                   success ? Success() : ErrorWith(absl::StatusCode::kUnavailable));
    stage.Promise(stage.HeldCancel(id).LetGo().ok(), "the wish is answered");
    stage.PromiseState(id, JobState::kCancelling);
    stage.Promise(finish.LetGo().ok(), "the end is taken");
    stage.PromiseState(id, success ? JobState::kSucceeded : JobState::kCancelled);
  }
}

void ReapAfterCancelAndFinish(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto finish = stage.HeldFinish(stage.Claim("late").fence, Success());
  stage.Promise(stage.store().RequestCancel("default", id, "tester").ok(), "the wish is taken");
  stage.ReapSilentWorkers();
  stage.PromiseState(id, JobState::kCancelled);
  stage.PromiseLeaseLost(finish.LetGo().status(), "a success after the end");
  stage.PromiseState(id, JobState::kCancelled);
}

void ReleaseAfterReap(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto release = stage.HeldRelease(stage.Claim("late").fence);
  stage.ReapSilentWorkers();
  stage.PromiseLeaseLost(release.LetGo(), "the late release");
  stage.PromiseState(id, JobState::kQueued);
  stage.Promise(stage.Get(id).losses == 1, "it was a loss");
}

void ReapAfterRelease(RaceStage& stage) {
  const std::string id = stage.Submit();
  const jobs::Fence fence = stage.Claim("late").fence;
  auto reap = stage.HeldReap();
  stage.Promise(stage.store().Release(fence, {}).ok(), "the release is taken");
  stage.Promise(reap.LetGo().value_or(-1) == 0, "nothing is left to reap");
  stage.PromiseState(id, JobState::kQueued);
  stage.Promise(stage.Get(id).losses == 0, "it was no loss");
}

void CheckpointAfterReap(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto save = stage.HeldCheckpoint(stage.Claim("late").fence, 'b', 9);
  stage.ReapSilentWorkers();
  stage.PromiseLeaseLost(save.LetGo(), "the late checkpoint");
  stage.Promise(!stage.Get(id).checkpoint, "the pointer stays");
  stage.PromiseState(id, JobState::kQueued);
}

void HeartbeatBeforeReap(RaceStage& stage) {
  const std::string id = stage.Submit();
  const jobs::Fence fence = stage.Claim("worker").fence;
  auto reap = stage.HeldReap();
  stage.Promise(stage.store().Heartbeat(fence, std::nullopt).ok(), "the heartbeat is taken");
  stage.Promise(reap.LetGo().value_or(-1) == 0, "nothing is reaped");
  stage.PromiseState(id, JobState::kRunning);
}

void TwoClaimsOfOneJob(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto late = stage.HeldClaim("one");
  const jobs::Lease lease = stage.Claim("other");
  stage.Promise(!late.LetGo().has_value(), "one of two gets the job");
  stage.Promise(lease.fence.job == id, "the first one does");
  stage.PromiseState(id, JobState::kRunning);
}

void ClaimAfterCancel(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto claim = stage.HeldClaim("worker");
  stage.Promise(stage.store().RequestCancel("default", id, "tester").ok(), "the wish is taken");
  stage.Promise(!claim.LetGo().has_value(), "a cancelled job is not started");
  stage.PromiseState(id, JobState::kCancelled);
}

void CancelAfterClaim(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto cancel = stage.HeldCancel(id);
  const jobs::Fence fence = stage.Claim("worker").fence;
  stage.Promise(cancel.LetGo().ok(), "the wish is taken");
  stage.PromiseState(id, JobState::kCancelling);
  const auto reply = stage.store().Heartbeat(fence, std::nullopt);
  stage.Promise(reply.ok() && reply->directive == jobs::Directive::kCancel, "the worker is told");
}

void RepeatedClaimAfterAnotherTookOver(RaceStage& stage) {
  const std::string id = stage.Submit();
  stage.TryClaim("slow", "token");  // its answer was lost
  stage.ReapSilentWorkers();
  const jobs::Fence owner = stage.Claim("owner").fence;
  const auto repeat = stage.TryClaim("slow", "token");
  stage.Promise(!repeat.has_value(), "the repeat does not give the owner's lease");
  stage.Promise(stage.store().Heartbeat(owner, std::nullopt).ok(), "the owner goes on");
  stage.PromiseState(id, JobState::kRunning);
}

void FinishAfterItsWorkerWasExpired(RaceStage& stage) {
  const std::string id = stage.Submit();
  auto finish = stage.HeldFinish(stage.Claim("worker").fence, Success());
  stage.Promise(stage.store().ExpireWorker("worker").value_or(-1) == 1, "its lease ends");
  stage.PromiseLeaseLost(finish.LetGo().status(), "the late success");
  stage.PromiseState(id, JobState::kQueued);
}

void FinishAfterDeadline(RaceStage& stage) {
  const std::string id = stage.Submit(absl::Seconds(10));
  auto finish = stage.HeldFinish(stage.Claim("worker").fence, Success());
  stage.ReapAfter(absl::Hours(1));
  stage.PromiseState(id, JobState::kFailed);
  stage.PromiseLeaseLost(finish.LetGo().status(), "a success after the end");
  stage.PromiseState(id, JobState::kFailed);
}

void ClaimAfterDeadline(RaceStage& stage) {
  const std::string id = stage.Submit(absl::Seconds(10));
  auto claim = stage.HeldClaim("worker");
  stage.ReapAfter(absl::Seconds(10));
  stage.Promise(!claim.LetGo().has_value(), "a job past its deadline is not started");
  stage.PromiseState(id, JobState::kFailed);
}

}  // namespace

const std::vector<RaceScenario>& OrderScenarios() {
  static const std::vector<RaceScenario> scenarios = {
      {"FinishAfterReap", Guard::kNone, &FinishAfterReap},
      {"ReapAfterFinish", Guard::kNone, &ReapAfterFinish},
      {"CancelAfterFinish", Guard::kNone, &CancelAfterFinish},
      {"FinishAfterCancel", Guard::kNone, &FinishAfterCancel},
      {"ReapAfterCancelAndFinish", Guard::kNone, &ReapAfterCancelAndFinish},
      {"ReleaseAfterReap", Guard::kNone, &ReleaseAfterReap},
      {"ReapAfterRelease", Guard::kNone, &ReapAfterRelease},
      {"CheckpointAfterReap", Guard::kNone, &CheckpointAfterReap},
      {"HeartbeatBeforeReap", Guard::kNone, &HeartbeatBeforeReap},
      {"TwoClaimsOfOneJob", Guard::kNone, &TwoClaimsOfOneJob},
      {"ClaimAfterCancel", Guard::kNone, &ClaimAfterCancel},
      {"CancelAfterClaim", Guard::kNone, &CancelAfterClaim},
      {"RepeatedClaimAfterAnotherTookOver", Guard::kNone, &RepeatedClaimAfterAnotherTookOver},
      {"FinishAfterDeadline", Guard::kNone, &FinishAfterDeadline},
      {"ClaimAfterDeadline", Guard::kNone, &ClaimAfterDeadline},
      {"FinishAfterItsWorkerWasExpired", Guard::kNone, &FinishAfterItsWorkerWasExpired},
  };
  return scenarios;
}

}  // namespace poise::testing
