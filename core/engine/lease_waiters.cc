#include "core/engine/lease_waiters.h"

#include <algorithm>
#include <utility>

#include "core/base/json.h"

namespace poise::engine {
namespace {

std::vector<std::string> Sorted(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return names;
}

std::string GroupKey(const jobs::ClaimQuery& query) {
  return base::Json{Sorted(query.queues), Sorted(query.kinds)}.dump(
      -1, ' ', false, base::Json::error_handler_t::replace);
}

}  // namespace

LeaseWaiters::Waiter::Waiter(LeaseWaiters& waiters, std::map<std::string, Group>::iterator group,
                             std::function<void()> wake)
    : waiters_(waiters),
      group_(group),
      wake_(std::make_shared<const std::function<void()>>(std::move(wake))) {}

LeaseWaiters::Waiter::~Waiter() {
  std::vector<Wake> wakes;
  {
    std::lock_guard lock(waiters_.mutex_);
    Group& group = group_->second;
    if (waiting_) group.waiting.erase(place_);
    if (woken_) TakeFirst(group, wakes);
    if (--group.members == 0) waiters_.groups_.erase(group_);
  }
  Call(wakes);
}

void LeaseWaiters::Waiter::Arm() {
  std::lock_guard lock(waiters_.mutex_);
  woken_ = false;
  if (waiting_) return;
  waiting_ = true;
  place_ = group_->second.waiting.insert(group_->second.waiting.end(), this);
}

void LeaseWaiters::Waiter::PassOn() {
  std::vector<Wake> wakes;
  {
    std::lock_guard lock(waiters_.mutex_);
    Group& group = group_->second;
    if (waiting_) group.waiting.erase(place_);
    waiting_ = false;
    woken_ = false;
    TakeFirst(group, wakes);
  }
  Call(wakes);
}

std::unique_ptr<LeaseWaiters::Waiter> LeaseWaiters::Join(const jobs::ClaimQuery& query,
                                                         std::function<void()> wake) {
  std::lock_guard lock(mutex_);
  const auto group = groups_.try_emplace(GroupKey(query)).first;
  group->second.kinds = query.kinds;
  ++group->second.members;
  return std::unique_ptr<Waiter>(new Waiter(*this, group, std::move(wake)));
}

void LeaseWaiters::JobReady(std::string_view kind) {
  std::vector<Wake> wakes;
  {
    std::lock_guard lock(mutex_);
    for (auto& [key, group] : groups_) {
      const bool asked = group.kinds.empty() || std::find(group.kinds.begin(), group.kinds.end(),
                                                          kind) != group.kinds.end();
      if (asked) TakeFirst(group, wakes);
    }
  }
  Call(wakes);
}

void LeaseWaiters::AnyJobReady() {
  std::vector<Wake> wakes;
  {
    std::lock_guard lock(mutex_);
    for (auto& [key, group] : groups_) TakeFirst(group, wakes);
  }
  Call(wakes);
}

void LeaseWaiters::WakeAll() {
  std::vector<Wake> wakes;
  {
    std::lock_guard lock(mutex_);
    for (auto& [key, group] : groups_) {
      while (!group.waiting.empty()) TakeFirst(group, wakes);
    }
  }
  Call(wakes);
}

void LeaseWaiters::TakeFirst(Group& group, std::vector<Wake>& wakes) {
  if (group.waiting.empty()) return;
  Waiter* first = group.waiting.front();
  group.waiting.pop_front();
  first->waiting_ = false;
  first->woken_ = true;
  wakes.push_back(first->wake_);
}

void LeaseWaiters::Call(const std::vector<Wake>& wakes) {
  for (const Wake& wake : wakes) (*wake)();
}

}  // namespace poise::engine
