#include "core/motion/motion_signature.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace poise::motion {
namespace {

// Rates that differ by less are written differently, not recorded differently (1 / 0.0083333 s).
constexpr double kRateTolerance = 1e-3;

constexpr std::array<std::pair<RotationRepresentation, const char*>, 5> kRepresentations = {
    {{RotationRepresentation::kQuaternion, "quaternion"},
     {RotationRepresentation::kMatrix, "matrix"},
     {RotationRepresentation::kSixD, "six_d"},
     {RotationRepresentation::kExponentialMap, "exponential_map"},
     {RotationRepresentation::kEuler, "euler"}}};

bool SameRate(double a, double b) { return std::abs(a - b) <= kRateTolerance * std::max(a, b); }

std::vector<const char*> Names(const std::vector<JointRole>& roles) {
  std::vector<const char*> names;
  for (const JointRole role : roles) names.push_back(RoleName(role));
  return names;
}

Status Malformed(std::string_view message) {
  return base::InvalidArgument("MALFORMED_SIGNATURE", "signature",
                               fmt::format("motion signature: {}", message));
}

}  // namespace

int MotionSignature::width() const {
  const int per_joint = RotationCodec{.representation = rotation}.width();
  return (with_root_position ? 3 : 0) + per_joint * static_cast<int>(roles.size());
}

std::vector<JointRole> RequiredRoles() {
  std::vector<JointRole> roles;
  for (int i = 0; i < kNumRequiredRoles; ++i) roles.push_back(static_cast<JointRole>(i));
  return roles;
}

const char* RotationRepresentationName(RotationRepresentation representation) {
  return kRepresentations[static_cast<size_t>(representation)].second;
}

base::Json ToJson(const MotionSignature& signature) {
  return {{"roles", Names(signature.roles)},
          {"rotation", RotationRepresentationName(signature.rotation)},
          {"root_position", signature.with_root_position},
          {"frame_rate", signature.frame_rate}};
}

StatusOr<MotionSignature> SignatureFromJson(const base::Json& json) {
  MotionSignature signature;
  std::string rotation;
  std::vector<std::string> roles;
  try {
    rotation = json.at("rotation");
    roles = json.at("roles").get<std::vector<std::string>>();
    signature.with_root_position = json.at("root_position");
    signature.frame_rate = json.at("frame_rate");
  } catch (const base::Json::exception&) {
    return Malformed("expected roles, rotation, root_position and frame_rate");
  }
  const auto found = std::find_if(kRepresentations.begin(), kRepresentations.end(),
                                  [&](const auto& entry) { return rotation == entry.second; });
  if (found == kRepresentations.end()) {
    return Malformed(fmt::format("unknown rotation '{}'", rotation));
  }
  signature.rotation = found->first;
  for (const std::string& name : roles) {
    const std::optional<JointRole> role = ParseRole(name);
    if (!role) {
      return base::InvalidArgument("UNKNOWN_ROLE", "signature.roles",
                                   fmt::format("unknown role '{}'", name));
    }
    signature.roles.push_back(*role);
  }
  if (signature.roles.empty()) return Malformed("there are no roles");
  if (!(signature.frame_rate > 0 && signature.frame_rate <= Clip::kMaxFrameRate)) {
    return Malformed(fmt::format("frame rate {} Hz", signature.frame_rate));
  }
  return signature;
}

std::vector<std::string> Differences(const MotionSignature& expected,
                                     const MotionSignature& actual) {
  std::vector<std::string> differences;
  if (expected.roles != actual.roles) {
    differences.push_back(fmt::format("joints {}, not {}", fmt::join(Names(actual.roles), " "),
                                      fmt::join(Names(expected.roles), " ")));
  }
  if (expected.rotation != actual.rotation) {
    differences.push_back(fmt::format("rotations as {}, not {}",
                                      RotationRepresentationName(actual.rotation),
                                      RotationRepresentationName(expected.rotation)));
  }
  if (expected.with_root_position != actual.with_root_position) {
    differences.push_back(actual.with_root_position ? "a root position, not none"
                                                    : "no root position");
  }
  if (!SameRate(expected.frame_rate, actual.frame_rate)) {
    differences.push_back(
        fmt::format("rate {} Hz, not {} Hz", actual.frame_rate, expected.frame_rate));
  }
  return differences;
}

Status CheckFits(const MotionSignature& signature, const std::string& model, const Clip& clip,
                 const JointRoles& roles) {
  std::vector<std::string> differences;
  std::vector<const char*> missing;
  for (const JointRole role : signature.roles) {
    if (!roles.has(role)) missing.push_back(RoleName(role));
  }
  if (!missing.empty()) {
    differences.push_back(
        fmt::format("no joint plays {} (map them by hand, or retarget the clip to a body that has "
                    "them)",
                    fmt::join(missing, ", ")));
  }
  if (!SameRate(signature.frame_rate, clip.frame_rate())) {
    differences.push_back(fmt::format("it has {} Hz, the model {} Hz (resample it)",
                                      clip.frame_rate(), signature.frame_rate));
  }
  if (differences.empty()) return absl::OkStatus();
  return base::FailedPrecondition("SIGNATURE_MISMATCH", "",
                                  fmt::format("clip '{}' does not fit model '{}': {}", clip.name(),
                                              model, fmt::join(differences, "; ")));
}

}  // namespace poise::motion
