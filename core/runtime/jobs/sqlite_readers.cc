#include "core/runtime/jobs/sqlite_readers.h"

#include <utility>

namespace poise::jobs::sqlite {

Readers::Readers(const std::filesystem::path& path, int count) : count_(count) {
  for (int i = 0; i < count; ++i) {
    idle_.push_back(std::make_unique<Connection>(path, Connection::Mode::kRead));
  }
}

std::unique_ptr<Connection> Readers::Take() {
  std::unique_lock lock(mutex_);
  returned_.wait(lock, [this] { return !held_ && !idle_.empty(); });
  std::unique_ptr<Connection> connection = std::move(idle_.back());
  idle_.pop_back();
  return connection;
}

void Readers::Return(std::unique_ptr<Connection> connection) {
  {
    std::lock_guard lock(mutex_);
    idle_.push_back(std::move(connection));
  }
  returned_.notify_all();  // readers wait, and WhileIdle may
}

void Readers::WhileIdle(const std::function<void()>& work) {
  std::unique_lock lock(mutex_);
  held_ = true;
  returned_.wait(lock, [this] { return idle_.size() == count_; });
  work();
  held_ = false;
  lock.unlock();
  returned_.notify_all();
}

}  // namespace poise::jobs::sqlite
