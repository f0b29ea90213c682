#include "tests/core/runtime/jobs/job_store_fixture.h"

// The pointer to the state that the next attempt begins from moves under the fence, and forward.
namespace poise::testing {
namespace {

using api::JobState;
using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;

class CheckpointTest : public JobStoreTest {
 protected:
  Status Commit(const jobs::Lease& lease, char digit, int64_t step) {
    return store().CommitCheckpoint(lease.fence, ArtifactName(digit), step);
  }
  void ExpectCheckpoint(const std::string& id, char digit, int64_t step, int attempt) {
    const auto checkpoint = Get(id).checkpoint;
    ASSERT_TRUE(checkpoint.has_value());
    EXPECT_EQ(checkpoint->artifact, ArtifactName(digit));
    EXPECT_EQ(checkpoint->step, step);
    EXPECT_EQ(checkpoint->attempt, attempt);
  }
};

TEST_P(CheckpointTest, TheNextAttemptBeginsFromTheLastOne) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  EXPECT_TRUE(Commit(lease, 'a', 10).ok());
  EXPECT_TRUE(Commit(lease, 'b', 20).ok());
  LoseAllWorkers();
  const jobs::Lease next = Claim();
  ASSERT_TRUE(next.checkpoint.has_value());
  EXPECT_EQ(next.checkpoint->artifact, ArtifactName('b'));
  EXPECT_EQ(next.checkpoint->step, 20);
  EXPECT_EQ(next.checkpoint->attempt, 1);
  const api::Job job = Get(id);
  EXPECT_EQ(job.attempts.at(0).from_step, 0);
  EXPECT_EQ(job.attempts.at(0).last_step, 20);
  EXPECT_EQ(job.attempts.at(1).from_step, 20);
  EXPECT_EQ(job.attempts.at(1).last_step, 20) << "it starts where it begins";
  ExpectSound();
}

TEST_P(CheckpointTest, CommittedTwiceIsOnce) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  EXPECT_TRUE(Commit(lease, 'a', 10).ok());
  const int64_t seq = Get(id).event_seq;
  EXPECT_TRUE(Commit(lease, 'a', 10).ok());
  EXPECT_EQ(Get(id).event_seq, seq);
}

TEST_P(CheckpointTest, OneThatWasOvertakenMovesNothing) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  EXPECT_TRUE(Commit(lease, 'b', 20).ok());
  EXPECT_TRUE(Commit(lease, 'a', 10).ok());
  ExpectCheckpoint(id, 'b', 20, 1);
}

TEST_P(CheckpointTest, AnAttemptThatBeginsAnewMayFallBack) {
  const std::string id = Submit();
  EXPECT_TRUE(Commit(Claim(), 'a', 100).ok());
  LoseAllWorkers();
  EXPECT_TRUE(Commit(Claim(), 'b', 5).ok());  // it could not use what the first one left
  ExpectCheckpoint(id, 'b', 5, 2);
  EXPECT_EQ(Get(id).losses, 1) << "not further than before";
}

TEST_P(CheckpointTest, AZombieDoesNotMoveIt) {
  const std::string id = Submit();
  const jobs::Lease zombie = Claim();
  LoseAllWorkers();
  EXPECT_EQ(ReasonOf(Commit(zombie, 'f', 99)), "LEASE_LOST");
  const jobs::Lease lease = Claim();
  EXPECT_TRUE(Commit(lease, 'a', 10).ok());
  EXPECT_EQ(ReasonOf(Commit(zombie, 'f', 99)), "LEASE_LOST");
  ExpectCheckpoint(id, 'a', 10, 2);
}

TEST_P(CheckpointTest, OfAJobThatIsCancelledItIsStillTaken) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  Cancel(id);
  EXPECT_TRUE(Commit(lease, 'a', 10).ok());
  EXPECT_EQ(Finish(lease, EndedAs(api::AttemptOutcome::kCancelled)), JobState::kCancelled);
  ExpectCheckpoint(id, 'a', 10, 1);
}

TEST_P(CheckpointTest, AJobThatTakesOverFromAnotherBeginsFromItsCheckpoint) {
  const std::string first = Submit();
  EXPECT_TRUE(Commit(Claim(), 'a', 40).ok());
  Cancel(first);
  LoseAllWorkers();
  jobs::NewJob request = Request();
  request.retry_of = first;
  request.checkpoint = Get(first).checkpoint;
  const std::string second = Submit(request);
  EXPECT_EQ(Get(second).retry_of, first);
  const jobs::Lease lease = Claim();
  ASSERT_TRUE(lease.checkpoint.has_value());
  EXPECT_EQ(lease.checkpoint->artifact, ArtifactName('a'));
  EXPECT_EQ(lease.checkpoint->step, 40);
  EXPECT_EQ(Get(second).attempts.at(0).from_step, 40);
}

TEST_P(CheckpointTest, TheStoreKnowsEveryArtifactThatIsNeeded) {
  jobs::NewJob request = Request();
  request.request.spec.parameters = {{"clip", ArtifactName('1')},
                                     {"deep", {{{"x", {ArtifactName('2')}}}}},
                                     {"not one", "artifacts/abc"}};
  const std::string id = Submit(request);
  const jobs::Lease lease = Claim();
  EXPECT_TRUE(Commit(lease, 'a', 10).ok());
  EXPECT_TRUE(Commit(lease, 'b', 20).ok());
  jobs::Outcome outcome = Success();
  outcome.artifacts = {{"x", ArtifactName('d'), 1, "text/plain"},
                       {"y", ArtifactName('e'), 2, "text/plain"}};
  Finish(lease, outcome);
  const auto needed = store().ReferencedArtifacts();
  ASSERT_TRUE(needed.ok()) << needed.status();
  EXPECT_THAT(*needed, IsSupersetOf({ArtifactName('1'), ArtifactName('2'), ArtifactName('b'),
                                     ArtifactName('d'), ArtifactName('e')}));
  EXPECT_THAT(*needed, Not(Contains(ArtifactName('a')))) << "a later checkpoint took its place";
  EXPECT_THAT(*needed, Not(Contains("artifacts/abc")));
  EXPECT_TRUE(store().Delete("default", id).ok());
  EXPECT_TRUE(store().ReferencedArtifacts()->empty());
}

INSTANTIATE_TEST_SUITE_P(Stores, CheckpointTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
