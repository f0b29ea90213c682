#include "tests/support/data_files.h"

#include <algorithm>
#include <cstdlib>

namespace poise::testing {

namespace fs = std::filesystem;

fs::path DataPath(const std::string& below) {
  const char* root = std::getenv("POISE_DATA_DIR");
  return fs::path(root == nullptr ? "" : root) / below;
}

std::string MissingData(const std::string& below) {
  const char* root = std::getenv("POISE_DATA_DIR");
  if (root == nullptr || *root == '\0') return "POISE_DATA_DIR is not set (wanted: " + below + ")";
  if (!fs::exists(DataPath(below))) return DataPath(below).string() + " does not exist";
  return "";
}

std::vector<fs::path> DataFiles(const std::string& below,
                                const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(DataPath(below))) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() &&
        std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace poise::testing
