#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <thread>

#include "core/base/random.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

// Lists are stable: paged with tokens of one filter, and whole while jobs come and go.
namespace poise::testing {
namespace {

using api::JobState;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::SizeIs;

class ListingTest : public JobStoreTest {
 protected:
  api::JobPage List(const jobs::ListQuery& query) {
    auto page = store().List(query);
    EXPECT_TRUE(page.ok()) << page.status();
    return page.ok() ? *page : api::JobPage{};
  }
  std::vector<std::string> AllPages(jobs::ListQuery query) {
    std::vector<std::string> ids;
    do {
      const api::JobPage page = List(query);
      for (const api::Job& job : page.jobs) ids.push_back(job.id);
      query.page_token = page.next_page_token;
    } while (!query.page_token.empty());
    return ids;
  }
  std::vector<std::string> Matching(const std::string& filter) {
    return AllPages({.filter = *api::JobFilter::Parse(filter)});
  }
};

TEST_P(ListingTest, NewestFirstWithoutAttempts) {
  const std::string first = RunJob(Success());
  const std::string second = Submit();
  const api::JobPage page = List({});
  ASSERT_THAT(page.jobs, SizeIs(2));
  EXPECT_EQ(page.jobs[0].id, second);
  EXPECT_EQ(page.jobs[1].id, first);
  EXPECT_EQ(page.jobs[1].state, JobState::kSucceeded);
  EXPECT_THAT(page.jobs[1].attempts, IsEmpty());
  EXPECT_EQ(page.next_page_token, "");
}

TEST_P(ListingTest, ATenantSeesItsOwn) {
  Submit();
  const std::string other = Submit(RequestOf("other"));
  EXPECT_THAT(AllPages({.tenant = "other"}), ElementsAre(other));
  EXPECT_THAT(AllPages({.tenant = "third"}), IsEmpty());
}

TEST_P(ListingTest, FiltersByStateKindQueueAndLabels) {
  jobs::NewJob request = Request();
  request.request.labels = {{"run", "7"}, {"a.b-c", "x=y"}};
  const std::string labelled = Submit(request);
  Finish(Claim(), ErrorWith(absl::StatusCode::kInternal));
  request.request.queue = "fast";
  request.request.labels = {{"run", "8"}};
  const std::string fast = Submit(request);
  Claim();
  request.request.spec.kind = "other";
  const std::string cancelling = Submit(request);
  Claim();
  Cancel(cancelling);

  EXPECT_THAT(Matching("state=FAILED"), ElementsAre(labelled));
  EXPECT_THAT(Matching("state=RUNNING"), ElementsAre(fast));
  EXPECT_THAT(Matching("state=CANCELLING"), ElementsAre(cancelling));
  EXPECT_THAT(Matching("state=QUEUED"), IsEmpty());
  EXPECT_THAT(Matching("kind=selftest"), ElementsAre(fast, labelled));
  EXPECT_THAT(Matching("queue=fast"), ElementsAre(cancelling, fast));
  EXPECT_THAT(Matching("label.run=7"), ElementsAre(labelled));
  EXPECT_THAT(Matching("label.a.b-c=x=y label.run=7"), ElementsAre(labelled));
  EXPECT_THAT(Matching("label.run=9"), IsEmpty());
  EXPECT_THAT(Matching("label.none="), IsEmpty());
  EXPECT_THAT(Matching("queue=fast kind=selftest state=RUNNING label.run=8"), ElementsAre(fast));
}

TEST_P(ListingTest, APageHasTheSizeThatWasAskedFor) {
  SubmitMany(Request(), 1100);
  EXPECT_THAT(List({.page_size = 7}).jobs, SizeIs(7));
  EXPECT_THAT(List({}).jobs, SizeIs(50)) << "by default";
  EXPECT_THAT(List({.page_size = 5000}).jobs, SizeIs(1000)) << "at most";
  EXPECT_THAT(AllPages({.page_size = 5000}), SizeIs(1100));
  const Status refused = store().List({.page_size = -1}).status();
  EXPECT_EQ(ReasonOf(refused), "BAD_PAGE_SIZE");
  EXPECT_EQ(base::ErrorField(refused), "page_size");
}

TEST_P(ListingTest, AListThatFitsExactlyHasNoFurtherPage) {
  SubmitMany(Request(), 4);
  EXPECT_EQ(List({.page_size = 4}).next_page_token, "");
  const std::string token = List({.page_size = 2}).next_page_token;
  EXPECT_EQ(List({.page_size = 2, .page_token = token}).next_page_token, "");
}

TEST_P(ListingTest, ATokenFitsItsTenantAndFilterOnly) {
  SubmitMany(Request(), 5);
  const std::string token = List({.page_size = 2}).next_page_token;
  ASSERT_NE(token, "");
  EXPECT_TRUE(store().List({.page_size = 3, .page_token = token}).ok()) << "the size may change";
  const auto refused = [&](const jobs::ListQuery& query) { return ReasonOf(store().List(query)); };
  const api::JobFilter queued = *api::JobFilter::Parse("state=QUEUED");
  EXPECT_EQ(refused({.filter = queued, .page_token = token}), "BAD_PAGE_TOKEN");
  EXPECT_EQ(refused({.tenant = "other", .page_token = token}), "BAD_PAGE_TOKEN");
  for (const char* bad : {"x", "0", "-", "ffffffffffffffffffff-0", "-1-0", "1-"}) {
    EXPECT_EQ(refused({.page_token = bad}), "BAD_PAGE_TOKEN") << bad;
  }
  EXPECT_EQ(refused({.page_token = token + "0"}), "BAD_PAGE_TOKEN");
  EXPECT_EQ(refused({.page_token = token.substr(1)}), "BAD_PAGE_TOKEN");
}

TEST_P(ListingTest, TheEndOfAPageMayBeDeleted) {
  const std::string oldest = Submit();
  Cancel(oldest);
  const std::string deleted = Submit();
  Cancel(deleted);
  Submit();
  const std::string token = List({.page_size = 2}).next_page_token;
  EXPECT_TRUE(store().Delete("default", deleted).ok());
  EXPECT_THAT(AllPages({.page_token = token}), ElementsAre(oldest));
}

// While others make, run and delete jobs, every walk over the pages finds each job that was there
// all the time, and none twice.
TEST_P(ListingTest, WalksOverPagesMissNothingWhileJobsComeAndGo) {
  std::set<std::string> throughout;
  for (int i = 0; i < 300; ++i) throughout.insert(Submit(Request(fmt::format("stays-{}", i))));
  std::atomic<bool> stop = false;
  std::thread others([&] {
    base::Random random(5);
    std::vector<std::string> ended;
    while (!stop) {
      const std::string id = Submit();
      Cancel(id);
      ended.push_back(id);
      const uint64_t victim = random.Index(ended.size());
      if (random.Uniform() < 0.7) {
        EXPECT_TRUE(store().Delete("default", ended[victim]).ok());
        ended.erase(ended.begin() + static_cast<int64_t>(victim));
      }
      if (random.Uniform() < 0.3) {
        if (const auto lease = TryClaim()) Release(*lease);
      }
    }
  });
  for (const int page_size : {1, 7, 50, 1000}) {
    for (const char* filter : {"", "kind=selftest", "queue=default label.none=x"}) {
      const auto ids = AllPages({.filter = *api::JobFilter::Parse(filter), .page_size = page_size});
      const std::set<std::string> distinct(ids.begin(), ids.end());
      EXPECT_EQ(distinct.size(), ids.size()) << "one came twice";
      if (std::string(filter).find("label") != std::string::npos) continue;
      EXPECT_TRUE(
          std::includes(distinct.begin(), distinct.end(), throughout.begin(), throughout.end()))
          << "one is missing; page size " << page_size << ", filter " << filter;
    }
  }
  stop = true;
  others.join();
  ExpectSound();
}

INSTANTIATE_TEST_SUITE_P(Stores, ListingTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
