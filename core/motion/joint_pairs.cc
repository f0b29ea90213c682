#include "core/motion/joint_pairs.h"

#include <fmt/format.h>

#include <map>
#include <string>

#include "absl/strings/ascii.h"

namespace poise::motion {
namespace {

// Spellings that the partner of a joint of this (lower-case) name could have.
std::vector<std::string> PartnerNames(const std::string& name) {
  std::vector<std::string> partners;
  for (const auto& [side, other] : {std::pair<std::string, std::string>{"left", "right"},
                                    std::pair<std::string, std::string>{"right", "left"}}) {
    if (const size_t at = name.find(side); at != std::string::npos) {
      partners.push_back(std::string(name).replace(at, side.size(), other));
    }
    const char letter = side[0], other_letter = other[0];
    std::string swapped = name;
    if (!name.empty() && name.front() == letter) {
      swapped.front() = other_letter;
      partners.push_back(swapped);
    }
    swapped = name;
    if (name.size() > 1 && name.back() == letter && !absl::ascii_isalnum(name[name.size() - 2])) {
      swapped.back() = other_letter;
      partners.push_back(swapped);
    }
  }
  return partners;
}

}  // namespace

StatusOr<std::vector<int>> FindJointPairs(const Skeleton& skeleton, const JointRoles& roles) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  std::map<std::string, int> by_name;
  for (int i = 0; i < skeleton.num_joints(); ++i) {
    std::string name = skeleton.joint(i).name;
    if (const size_t colon = name.rfind(':'); colon != std::string::npos) name.erase(0, colon + 1);
    by_name[absl::AsciiStrToLower(name)] = i;
  }
  std::vector<int> partners(skeleton.num_joints());
  for (int i = 0; i < skeleton.num_joints(); ++i) partners[i] = i;
  for (const auto& [name, joint] : by_name) {
    for (const std::string& other : PartnerNames(name)) {
      const auto found = by_name.find(other);
      if (found != by_name.end()) partners[joint] = found->second;
    }
  }
  for (int i = 0; i < kNumRoles; ++i) {
    const auto role = static_cast<JointRole>(i);
    if (!roles.has(role)) continue;
    const JointRole other = roles.has(MirrorRole(role)) ? MirrorRole(role) : role;
    partners[roles.joint(role)] = roles.joint(other);
  }
  for (int i = 0; i < skeleton.num_joints(); ++i) {
    const int partner = partners[i];
    const int parent = skeleton.parent(i), partner_parent = skeleton.parent(partner);
    const bool parents_match = parent < 0 || partner_parent < 0
                                   ? parent == partner_parent
                                   : partners[parent] == partner_parent;
    if (partners[partner] == i && parents_match) continue;
    const auto name_of = [&](int joint) {
      return joint < 0 ? "(none)" : skeleton.joint(joint).name;
    };
    return base::FailedPrecondition(
        "ASYMMETRIC_SKELETON", "skeleton",
        fmt::format("joint '{}' on '{}' and its partner '{}' on '{}' are no mirror images",
                    name_of(i), name_of(parent), name_of(partner), name_of(partner_parent)));
  }
  return partners;
}

}  // namespace poise::motion
