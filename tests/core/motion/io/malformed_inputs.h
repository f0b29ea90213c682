#ifndef POISE_TESTS_CORE_MOTION_IO_MALFORMED_INPUTS_H_
#define POISE_TESTS_CORE_MOTION_IO_MALFORMED_INPUTS_H_

#include <string>
#include <vector>

#include "core/motion/io/clip_file.h"

/// Tables of malformed inputs: each gives one error that names the file, the line or entry, and
/// what was expected.
namespace poise::testing {

struct Malformed {
  std::string what;
  std::string data;
  std::string reason;
  std::vector<std::string> message;  ///< parts of it
};

void ExpectErrors(const std::string& file, motion::ClipFormat format,
                  const std::vector<Malformed>& table, const std::string& skeleton = "");

/// `text` with the first `from`, which must be there, replaced.
std::string Replace(std::string text, const std::string& from, const std::string& to);

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_MOTION_IO_MALFORMED_INPUTS_H_
