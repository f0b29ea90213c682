#include "tests/support/process_inspection.h"

#include <fmt/format.h>
#include <time.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace poise::testing {
namespace {

namespace fs = std::filesystem;

std::string ReadFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A number behind "NAME:" in /proc/PID/status.
int64_t StatusNumber(const std::string& status, const std::string& name) {
  const size_t at = status.find(name + ":");
  return at == std::string::npos ? 0 : std::atoll(status.c_str() + at + name.size() + 1);
}

}  // namespace

std::vector<pid_t> ChildrenOf(pid_t pid) {
  std::vector<pid_t> children;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/proc", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string status = ReadFile(entry.path() / "status");
    if (StatusNumber(status, "\nPPid") == pid) children.push_back(std::stoi(name));
  }
  return children;
}

std::vector<pid_t> LivingChildrenOf(pid_t pid) {
  std::vector<pid_t> children = ChildrenOf(pid);
  std::erase_if(children, [](pid_t child) {
    const std::string status = ReadFile(fmt::format("/proc/{}/status", child));
    return status.empty() || status.find("\nState:\tZ") != std::string::npos;
  });
  return children;
}

ProcessSize SizeOf(pid_t pid) {
  const fs::path folder = fmt::format("/proc/{}", pid);
  const std::string status = ReadFile(folder / "status");
  ProcessSize size{.resident_bytes = StatusNumber(status, "\nVmRSS") * 1024,
                   .threads = StatusNumber(status, "\nThreads")};
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder / "fd", ignored)) {
    (void)entry;
    ++size.descriptors;
  }
  return size;
}

double CpuSecondsOf(pid_t pid) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0) return -1;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace poise::testing
