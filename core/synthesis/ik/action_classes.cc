#include "core/synthesis/ik/action_classes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "core/base/config_fields.h"

namespace poise::synthesis {
namespace {

// A punch is edited at the foot: both the paper and its program do, since the foot varies more.
constexpr ActionClass kActionClasses[] = {
    // name       limb           two_sided  radius    height    angle
    {"kick", LimbKind::kLeg, false, 0.8, 1.2, 0.8, 1.2, 0.785},
    {"punch", LimbKind::kLeg, true, 0.5, 2.0, 1.0, 1.0, 1.7},
    {"walk", LimbKind::kLeg, true, 0.5, 2.0, 1.0, 1.0, 0.3},
    {"jog", LimbKind::kLeg, true, 0.5, 2.0, 1.0, 1.0, 0.3},
    {"sneak", LimbKind::kLeg, true, 0.5, 2.0, 1.0, 1.0, 0.3},
    {"grab", LimbKind::kArm, false, 0.5, 2.0, 1.0, 1.0, 1.7},
    {"deposit", LimbKind::kArm, false, 0.5, 2.0, 1.0, 1.0, 1.7},
    {"throw", LimbKind::kArm, false, 0.5, 2.0, 1.0, 1.0, 1.7},
};

}  // namespace

std::span<const ActionClass> ActionClasses() { return kActionClasses; }

StatusOr<ActionClass> FindActionClass(std::string_view name) {
  std::vector<std::string> names;
  for (const ActionClass& action_class : kActionClasses) {
    if (name == action_class.name) return action_class;
    names.push_back(action_class.name);
  }
  const std::string nearest = base::NearestName(name, names);
  return base::InvalidArgument(
      "UNKNOWN_ACTION_CLASS", "action_class",
      fmt::format("unknown action class '{}'; classes: {}{}", name, fmt::join(names, ", "),
                  nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

}  // namespace poise::synthesis
