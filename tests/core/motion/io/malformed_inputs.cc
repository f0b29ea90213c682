#include "tests/core/motion/io/malformed_inputs.h"

#include <gtest/gtest.h>

namespace poise::testing {

void ExpectErrors(const std::string& file, motion::ClipFormat format,
                  const std::vector<Malformed>& table, const std::string& skeleton) {
  for (const Malformed& entry : table) {
    const auto result = motion::DecodeClip(file, entry.data, format, {}, skeleton);
    ASSERT_FALSE(result.ok()) << entry.what;
    const std::string message = base::Message(result.status());
    EXPECT_EQ(result.status().code(), absl::StatusCode::kInvalidArgument) << entry.what;
    EXPECT_EQ(base::ErrorReason(result.status()), entry.reason) << entry.what << ": " << message;
    EXPECT_EQ(message.rfind(file + ": ", 0), 0u) << entry.what << ": " << message;
    for (const std::string& part : entry.message) {
      EXPECT_NE(message.find(part), std::string::npos) << entry.what << ": " << message;
    }
  }
}

std::string Replace(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace poise::testing
