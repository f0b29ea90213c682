#include "client/cli/push_input.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>

#include "client/cli/file_access.h"
#include "core/base/json.h"
#include "core/motion/io/clip_file.h"

namespace poise::cli {
namespace {

using base::Json;
using motion::Vec3;

constexpr double kLineSpacing = 0.35;     // [m]
constexpr double kDiamondSpacing = 0.45;  // [m]
constexpr double kPushSeconds = 0.2;

// Impulses [N s]: about the middles of the thirds of the recorded pushes on formations.
const std::map<std::string, double, std::less<>> kLevels = {
    {"weak", 25}, {"medium", 40}, {"strong", 65}};

template <typename Number>
std::optional<Number> ParseNumber(std::string_view text) {
  Number value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

// Cuts off what follows the first `separator`; nullopt when there is none.
std::optional<std::string_view> CutTail(std::string_view& text, char separator) {
  const size_t at = text.find(separator);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view tail = text.substr(at + 1);
  text = text.substr(0, at);
  return tail;
}

std::vector<Vec3> Line(int people, double spacing) {
  std::vector<Vec3> places;
  for (int i = 0; i < people; ++i) places.emplace_back(i * spacing, 0, 0);
  return places;
}

// Rows of 1, 3, ..., 2 n - 1, ..., 3, 1.
std::vector<Vec3> Diamond(int n, double spacing) {
  std::vector<Vec3> places;
  for (int row = 0; row < 2 * n - 1; ++row) {
    const int side = std::min(row, 2 * n - 2 - row);
    for (int i = -side; i <= side; ++i) places.emplace_back(row * spacing, 0, -i * spacing);
  }
  return places;
}

Status BadPush(std::string_view text) {
  return base::InvalidArgument(
      "BAD_PUSH", "push",
      fmt::format("push '{}', expected PERSON:STRENGTH[:DIRECTION][@SECONDS] such as 0:strong, "
                  "2:40Ns:90@0.5; strengths are weak, medium, strong or newton seconds",
                  text));
}

std::optional<double> Impulse(std::string_view strength) {
  const auto level = kLevels.find(strength);
  if (level != kLevels.end()) return level->second;
  if (!strength.ends_with("Ns")) return std::nullopt;
  return ParseNumber<double>(strength.substr(0, strength.size() - 2));
}

Status Malformed(const std::string& path, const std::string& problem) {
  return base::InvalidArgument("MALFORMED_SCENE", "people", fmt::format("{}: {}", path, problem));
}

// [x, z] as a vector on the floor.
Vec3 OnFloor(const Json& pair) { return {pair.at(0).get<double>(), 0, pair.at(1).get<double>()}; }

StatusOr<api::PushPerson> ReadPerson(const Json& json, const std::filesystem::path& folder) {
  api::PushPerson person;
  person.id = json.value("id", "");
  person.frame = json.value("frame", 0);
  person.mass_kg = json.value("mass_kg", person.mass_kg);
  if (json.contains("place")) person.place = OnFloor(json.at("place"));
  if (json.contains("file")) {
    POISE_ASSIGN_OR_RETURN(motion::ClipFile file,
                           motion::ReadClipFile(folder / json.at("file").get<std::string>()));
    person.body = api::ClipSource{std::move(file.clip), {}};
  }
  return person;
}

StatusOr<api::PushForce> ReadPush(const Json& json) {
  if (json.is_string()) return ParsePush(json.get<std::string>());
  api::PushForce push;
  push.person = base::IntegerFrom<int>(json.at("person"));
  push.start_s = json.value("start_s", 0.0);
  push.duration_s = json.value("duration_s", kPushSeconds);
  push.impulse_ns = OnFloor(json.at("impulse_ns"));
  push.height = json.value("height", 1.0);
  return push;
}

}  // namespace

StatusOr<std::vector<Vec3>> FormationPlaces(std::string_view text) {
  std::string_view name = text;
  std::string_view count_text = CutTail(name, ':').value_or("");
  const std::optional<std::string_view> spacing_text = CutTail(count_text, ':');
  const std::optional<int> people = ParseNumber<int>(count_text);
  const std::optional<double> spacing =
      spacing_text ? ParseNumber<double>(*spacing_text)
                   : std::optional(name == "line" ? kLineSpacing : kDiamondSpacing);
  const auto refuse = [&](const std::string& expected) {
    return base::InvalidArgument("BAD_FORMATION", "people",
                                 fmt::format("people '{}', expected {}", text, expected));
  };
  if ((name != "line" && name != "diamond") || !people || !spacing || !std::isfinite(*spacing)) {
    return refuse("line:N, diamond:N (each with :SPACING in metres) or a scene file");
  }
  if (*people < 1 || *people > api::PushSpec::kMaxPeople) {
    return refuse(fmt::format("1 to {} people", api::PushSpec::kMaxPeople));
  }
  if (name == "line") return Line(*people, *spacing);
  for (int n = 1; n * n + (n - 1) * (n - 1) <= *people; ++n) {
    if (n * n + (n - 1) * (n - 1) == *people) return Diamond(n, *spacing);
  }
  return refuse("a diamond of 1, 5, 13, 25, 41, ... people");
}

StatusOr<api::PushForce> ParsePush(std::string_view text) {
  std::string_view person_text = text;
  const std::optional<std::string_view> start_text = CutTail(person_text, '@');
  std::string_view strength = CutTail(person_text, ':').value_or("");
  const std::optional<std::string_view> direction_text = CutTail(strength, ':');
  const std::optional<int> person = ParseNumber<int>(person_text);
  const std::optional<double> impulse = Impulse(strength);
  const std::optional<double> start = ParseNumber<double>(start_text.value_or("0"));
  const std::optional<double> degrees = ParseNumber<double>(direction_text.value_or("0"));
  if (!person || !impulse || !start || !degrees) return BadPush(text);
  const double direction = *degrees * std::numbers::pi / 180;
  return api::PushForce{
      .person = *person,
      .start_s = *start,
      .duration_s = kPushSeconds,
      .impulse_ns = {*impulse * std::cos(direction), 0, -*impulse * std::sin(direction)}};
}

StatusOr<api::PushSpec> ReadSceneFile(const std::string& path) {
  POISE_ASSIGN_OR_RETURN(const std::string text, ReadFile(path));
  POISE_ASSIGN_OR_RETURN(const Json json, base::ParseJson(text, path));
  try {
    api::PushSpec spec;
    spec.duration_s = json.value("duration_s", spec.duration_s);
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    for (const Json& person : json.at("people")) {
      POISE_ASSIGN_OR_RETURN(api::PushPerson read, ReadPerson(person, folder));
      spec.people.push_back(std::move(read));
    }
    for (const Json& push : json.value("pushes", Json::array())) {
      POISE_ASSIGN_OR_RETURN(api::PushForce read, ReadPush(push));
      spec.pushes.push_back(read);
    }
    return spec;
  } catch (const Json::exception& error) {
    return Malformed(path, error.what());
  }
}

}  // namespace poise::cli
