#include "core/base/fail_point.h"

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

namespace poise::base {
namespace internal {

std::atomic<int> active_fail_points = 0;

namespace {

std::mutex mutex;

std::map<std::string, std::function<void()>>& Actions() {
  static auto* const actions = new std::map<std::string, std::function<void()>>;
  return *actions;
}

}  // namespace

void HitFailPoint(const char* name) {
  std::function<void()> action;
  {
    std::lock_guard lock(mutex);
    const auto entry = Actions().find(name);
    if (entry == Actions().end()) return;
    action = entry->second;
  }
  action();  // may wait long
}

}  // namespace internal

namespace {

std::function<void()> Action(const std::string& text) {
  const size_t colon = text.find(':');
  const std::string verb = text.substr(0, colon);
  const long number = colon == std::string::npos ? 1 : std::atol(text.c_str() + colon + 1);
  if (verb == "sleep") {
    return [number] { std::this_thread::sleep_for(std::chrono::milliseconds(number)); };
  }
  return [left = std::make_shared<std::atomic<long>>(number)] {
    if (--*left == 0) kill(getpid(), SIGKILL);
  };
}

}  // namespace

void SetFailPoint(const std::string& name, std::function<void()> action) {
  std::lock_guard lock(internal::mutex);
  auto& actions = internal::Actions();
  if (action) {
    actions[name] = std::move(action);
  } else {
    actions.erase(name);
  }
  internal::active_fail_points = static_cast<int>(actions.size());
}

void SetFailPointsFromEnvironment() {
  const char* const variable = std::getenv("POISE_FAIL_POINTS");
  if (variable == nullptr) return;
  std::istringstream entries(variable);
  for (std::string entry; std::getline(entries, entry, ',');) {
    const size_t equals = entry.find('=');
    if (equals != std::string::npos) {
      SetFailPoint(entry.substr(0, equals), Action(entry.substr(equals + 1)));
    }
  }
}

}  // namespace poise::base
