#ifndef POISE_TESTS_SUPPORT_DATA_FILES_H_
#define POISE_TESTS_SUPPORT_DATA_FILES_H_

#include <filesystem>
#include <string>
#include <vector>

/// Real motion data lives outside the project: POISE_DATA_DIR names its folder. A test that needs
/// it begins with POISE_REQUIRE_DATA("hdm05/kickLFront1Reps") and is skipped, naming the missing
/// path, where it is absent.
namespace poise::testing {

/// The folder or file below POISE_DATA_DIR.
std::filesystem::path DataPath(const std::string& below);

/// Why it cannot be used, or empty.
std::string MissingData(const std::string& below);

/// All files below with one of these endings (".amc"), sorted.
std::vector<std::filesystem::path> DataFiles(const std::string& below,
                                             const std::vector<std::string>& extensions);

}  // namespace poise::testing

#define POISE_REQUIRE_DATA(below)                                                     \
  do {                                                                                \
    const std::string poise_missing = ::poise::testing::MissingData(below);           \
    if (!poise_missing.empty()) GTEST_SKIP() << "needs real data: " << poise_missing; \
  } while (false)

#endif  // POISE_TESTS_SUPPORT_DATA_FILES_H_
