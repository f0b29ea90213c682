#include "core/motion/dataset/labelled_clip.h"

#include <cctype>
#include <vector>

#include "absl/strings/str_split.h"

namespace poise::motion {

ClipLabels LabelsOf(std::string_view stem) {
  const std::vector<std::string> parts = absl::StrSplit(std::string(stem), '_');
  if (parts.size() < 4 || parts[0] != "HDM") return {};
  return {.action = parts[2], .actor = parts[1]};
}

bool IsOfClass(std::string_view action, std::string_view action_class) {
  if (action_class.empty() || !action.starts_with(action_class)) return false;
  if (action.size() == action_class.size()) return true;
  const auto next = static_cast<unsigned char>(action[action_class.size()]);
  return std::isupper(next) || std::isdigit(next);
}

}  // namespace poise::motion
