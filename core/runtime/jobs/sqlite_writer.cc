#include "core/runtime/jobs/sqlite_writer.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/fail_point.h"

namespace poise::jobs::sqlite {
namespace {

// Bounds how long the first of a group waits for the last.
constexpr size_t kMaxGroup = 256;

}  // namespace

Writer::Writer(std::unique_ptr<Connection> connection, const JobPolicy& policy,
               std::function<absl::Time()> clock, std::function<void(Connection&)> after_commit)
    : connection_(std::move(connection)),
      policy_(policy),
      clock_(std::move(clock)),
      after_commit_(std::move(after_commit)),
      thread_([this] { Loop(); }) {}

Writer::~Writer() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  arrived_.notify_all();
  thread_.join();
}

void Writer::SetListener(JobStore::Listener listener) {
  std::lock_guard lock(mutex_);
  listener_ = std::move(listener);
}

Status Writer::Run(Work work) {
  // Shared: the answer wakes the caller before the writer has let go of the promise.
  const auto call = std::make_shared<Call>(std::move(work));
  std::future<Status> answer = call->answer.get_future();
  {
    std::lock_guard lock(mutex_);
    waiting_.push_back(call);
  }
  arrived_.notify_one();
  return answer.get();
}

void Writer::Loop() {
  for (;;) {
    std::vector<std::shared_ptr<Call>> calls;
    {
      std::unique_lock lock(mutex_);
      arrived_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      const auto end = waiting_.begin() + std::min(waiting_.size(), kMaxGroup);
      calls.assign(waiting_.begin(), end);
      waiting_.erase(waiting_.begin(), end);
    }
    CommitTogether(calls);
  }
}

void Writer::CommitTogether(const std::vector<std::shared_ptr<Call>>& calls) {
  std::vector<Transition> transitions;
  std::vector<std::string> news;
  const Status committed = Caught([&] {
    connection_->Run("BEGIN IMMEDIATE");
    for (const auto& call : calls) {
      call->status = RunOne(*call, transitions, news);
      // A full disk takes the whole transaction with it.
      if (!connection_->InTransaction()) return call->status;
    }
    base::FailPoint("store.before_commit");
    connection_->Run("COMMIT");
    return absl::OkStatus();
  });
  if (committed.ok()) {
    base::FailPoint("store.after_commit");
    Tell(transitions, news);
  } else if (connection_->InTransaction()) {
    (void)Caught([&] { return connection_->Run("ROLLBACK"), absl::OkStatus(); });
  }
  for (const auto& call : calls) call->answer.set_value(committed.ok() ? call->status : committed);
  after_commit_(*connection_);
}

Status Writer::RunOne(Call& call, std::vector<Transition>& transitions,
                      std::vector<std::string>& news) {
  Transaction transaction{*connection_, policy_,
                          absl::FromUnixMillis(absl::ToUnixMillis(clock_()))};
  connection_->Run("SAVEPOINT call");
  const Status status = Caught([&] { return call.work(transaction); });
  if (!connection_->InTransaction()) return status;
  if (!status.ok()) connection_->Run("ROLLBACK TO call");
  connection_->Run("RELEASE call");
  if (!status.ok()) return status;
  std::move(transaction.transitions.begin(), transaction.transitions.end(),
            std::back_inserter(transitions));
  std::move(transaction.jobs_with_news.begin(), transaction.jobs_with_news.end(),
            std::back_inserter(news));
  return status;
}

void Writer::Tell(const std::vector<Transition>& transitions,
                  const std::vector<std::string>& news) {
  if (transitions.empty() && news.empty()) return;
  JobStore::Listener listener;
  {
    std::lock_guard lock(mutex_);
    listener = listener_;
  }
  if (listener.on_transition) {
    for (const Transition& transition : transitions) listener.on_transition(transition);
  }
  if (listener.on_event) {
    for (const std::string& job : news) listener.on_event(job);
  }
}

}  // namespace poise::jobs::sqlite
