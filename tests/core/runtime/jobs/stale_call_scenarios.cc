#include <string>

#include "tests/core/runtime/jobs/race_scenarios.h"

namespace poise::testing {
namespace {

using api::JobState;

// The first worker was silent, its job runs at a second one, and only now the first one's call
// arrives.
struct Zombie {
  std::string id;
  jobs::Fence stale;
  jobs::Fence owner;
};

// `begin` starts the stale call and holds it; `check` lets it go and judges its answer.
template <typename Begin, typename Check>
void AgainstZombie(RaceStage& stage, Begin begin, Check check) {
  Zombie zombie{.id = stage.Submit(), .stale = stage.Claim("zombie").fence, .owner = {}};
  auto held = begin(zombie.stale);
  stage.ReapSilentWorkers();
  zombie.owner = stage.Claim("owner").fence;
  check(held.LetGo(), zombie);
  stage.PromiseState(zombie.id, JobState::kRunning);
  const auto committed = stage.store().Finish(zombie.owner, SuccessWith('a'));
  stage.Promise(committed.ok() && *committed == JobState::kSucceeded, "the owner commits");
  stage.PromiseState(zombie.id, JobState::kSucceeded);
  const api::Job job = stage.Get(zombie.id);
  stage.Promise(job.artifacts == SuccessWith('a').artifacts, "the result is the owner's");
  stage.Promise(job.attempt == 2, "nobody ran it a third time");
}

void ZombieSucceeds(RaceStage& stage) {
  AgainstZombie(
      stage, [&](const jobs::Fence& stale) { return stage.HeldFinish(stale, SuccessWith('b')); },
      [&](const auto& answer, const Zombie&) {
        stage.PromiseLeaseLost(answer.status(), "the zombie's success");
      });
}

void ZombieFails(RaceStage& stage) {
  AgainstZombie(
      stage,
      [&](const jobs::Fence& stale) {
        return stage.HeldFinish(stale, ErrorWith(absl::StatusCode::kInvalidArgument));
      },
      [&](const auto& answer, const Zombie& zombie) {
        stage.PromiseLeaseLost(answer.status(), "the zombie's error");
        stage.Promise(stage.Get(zombie.id).errors == 0, "it costs the job nothing");
      });
}

void ZombieSavesACheckpoint(RaceStage& stage) {
  AgainstZombie(
      stage, [&](const jobs::Fence& stale) { return stage.HeldCheckpoint(stale, 'b', 99); },
      [&](const Status& answer, const Zombie& zombie) {
        stage.PromiseLeaseLost(answer, "the zombie's checkpoint");
        stage.Promise(!stage.Get(zombie.id).checkpoint, "the pointer stays");
      });
}

void ZombieBeats(RaceStage& stage) {
  AgainstZombie(
      stage, [&](const jobs::Fence& stale) { return stage.HeldHeartbeat(stale, 99); },
      [&](const auto& answer, const Zombie& zombie) {
        stage.PromiseLeaseLost(answer.status(), "the zombie's heartbeat");
        stage.Promise(stage.Get(zombie.id).progress.step == 0, "its progress is not told");
      });
}

void ZombieReleases(RaceStage& stage) {
  AgainstZombie(
      stage, [&](const jobs::Fence& stale) { return stage.HeldRelease(stale); },
      [&](const Status& answer, const Zombie&) {
        stage.PromiseLeaseLost(answer, "the zombie's release");
      });
}

void ZombieRepeatsItsError(RaceStage& stage) {
  const std::string id = stage.Submit();
  const jobs::Fence first = stage.Claim("first").fence;
  const jobs::Outcome stalled = EndedAs(api::AttemptOutcome::kLost);  // no pause before the next
  stage.Promise(stage.store().Finish(first, stalled).ok(), "the attempt ends");
  auto repeat = stage.HeldFinish(first, stalled);  // the answer was lost
  stage.Claim("second");
  const auto answer = repeat.LetGo();
  stage.Promise(answer.ok() && *answer == JobState::kQueued, "the repeat tells what the first did");
  stage.PromiseState(id, JobState::kRunning);
  stage.Promise(stage.Get(id).losses == 1, "it counts once");
}

void ZombieWithTheSameToken(RaceStage& stage) {
  const std::string id = stage.Submit();
  const auto first = stage.TryClaim("worker", "token");
  auto stale = stage.HeldFinish(first->fence, SuccessWith('b'));
  stage.ReapSilentWorkers();
  const auto second = stage.TryClaim("worker", "token");  // it asks again, as its answer was lost
  stage.Promise(second && second->fence.attempt == 2, "the worker has a second attempt");
  stage.PromiseLeaseLost(stale.LetGo().status(), "the first attempt's success");
  stage.PromiseState(id, JobState::kRunning);
}

void StrangerWithoutTheToken(RaceStage& stage) {
  const std::string id = stage.Submit();
  jobs::Fence fence = stage.Claim("owner").fence;
  fence.token = "guessed";
  auto finish = stage.HeldFinish(fence, SuccessWith('b'));
  stage.PromiseLeaseLost(stage.store().Heartbeat(fence, std::nullopt).status(), "the heartbeat");
  stage.PromiseLeaseLost(stage.store().CommitCheckpoint(fence, ArtifactName('b'), 9), "the save");
  stage.PromiseLeaseLost(stage.store().Release(fence, {}), "the release");
  stage.PromiseLeaseLost(finish.LetGo().status(), "the success");
  stage.PromiseState(id, JobState::kRunning);
}

void FenceOfAnotherJob(RaceStage& stage) {
  const std::string one = stage.Submit();
  const jobs::Fence of_one = stage.Claim("one").fence;
  const std::string other = stage.Submit();
  const jobs::Fence of_other = stage.Claim("other").fence;
  auto finish = stage.HeldFinish({one, 1, of_other.token}, SuccessWith('b'));
  stage.PromiseLeaseLost(stage.store().Release({other, 1, of_one.token}, {}), "a mixed fence");
  stage.PromiseLeaseLost(finish.LetGo().status(), "another mixed fence");
  stage.PromiseState(one, JobState::kRunning);
  stage.PromiseState(other, JobState::kRunning);
}

}  // namespace

const std::vector<RaceScenario>& StaleCallScenarios() {
  static const std::vector<RaceScenario> scenarios = {
      {"ZombieSucceeds", Guard::kAttemptOrToken, &ZombieSucceeds},
      {"ZombieFails", Guard::kAttemptOrToken, &ZombieFails},
      {"ZombieSavesACheckpoint", Guard::kAttemptOrToken, &ZombieSavesACheckpoint},
      {"ZombieBeats", Guard::kAttemptOrToken, &ZombieBeats},
      {"ZombieReleases", Guard::kAttemptOrToken, &ZombieReleases},
      {"ZombieRepeatsItsError", Guard::kAttemptOrToken, &ZombieRepeatsItsError},
      {"ZombieWithTheSameToken", Guard::kAttempt, &ZombieWithTheSameToken},
      {"StrangerWithoutTheToken", Guard::kToken, &StrangerWithoutTheToken},
      {"FenceOfAnotherJob", Guard::kToken, &FenceOfAnotherJob},
  };
  return scenarios;
}

}  // namespace poise::testing
