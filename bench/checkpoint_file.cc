#include "bench/checkpoint_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

namespace poise::bench {

namespace fs = std::filesystem;

CheckpointFile::CheckpointFile(std::string path) : path_(std::move(path)) {
  const fs::path folder = fs::path(path_).parent_path();
  if (!folder.empty()) fs::create_directories(folder);
}

std::optional<std::string> CheckpointFile::Read() const {
  std::ifstream file(path_, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

learning::CheckpointSink CheckpointFile::Sink(absl::Duration interval) const {
  return {.interval = interval, .save = [this](std::string_view bytes, int64_t) {
            const std::string fresh = path_ + ".new";
            std::ofstream(fresh, std::ios::binary) << bytes;
            fs::rename(fresh, path_);
            return absl::OkStatus();
          }};
}

void CheckpointFile::Remove() const { fs::remove(path_); }

}  // namespace poise::bench
