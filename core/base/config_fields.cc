#include "core/base/config_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "absl/strings/numbers.h"

namespace poise::base {
namespace {

Status Malformed(const Field& field, std::string_view text, std::string_view expected) {
  return InvalidArgument("MALFORMED_CONFIG_VALUE", field.name,
                         fmt::format("'{}' expects {}, got '{}'", field.name, expected, text));
}

Status CheckRange(const Field& field) {
  const auto check = [&](double value) -> Status {
    if (value >= field.low && value <= field.high) return absl::OkStatus();  // NaN fails too
    return InvalidArgument(
        "CONFIG_VALUE_OUT_OF_RANGE", field.name,
        fmt::format("'{}' must lie in [{}, {}], got {}", field.name, field.low, field.high, value));
  };
  if (const auto* number = std::get_if<double*>(&field.value)) return check(**number);
  if (const auto* number = std::get_if<int*>(&field.value)) return check(**number);
  if (const auto* number = std::get_if<int64_t*>(&field.value)) {
    return check(static_cast<double>(**number));
  }
  if (const auto* text = std::get_if<std::string*>(&field.value); text && !field.choices.empty()) {
    if (std::find(field.choices.begin(), field.choices.end(), **text) == field.choices.end()) {
      return InvalidArgument("CONFIG_VALUE_OUT_OF_RANGE", field.name,
                             fmt::format("'{}' must be one of {}, got '{}'", field.name,
                                         fmt::join(field.choices, ", "), **text));
    }
  }
  return absl::OkStatus();
}

Status SetFromText(const Field& field, const std::string& text) {
  bool parsed = true;
  if (auto* number = std::get_if<double*>(&field.value)) {
    parsed = absl::SimpleAtod(text, *number);
    if (!parsed) return Malformed(field, text, "a number");
  } else if (auto* number = std::get_if<int*>(&field.value)) {
    if (!absl::SimpleAtoi(text, *number)) return Malformed(field, text, "an integer");
  } else if (auto* number = std::get_if<int64_t*>(&field.value)) {
    if (!absl::SimpleAtoi(text, *number)) return Malformed(field, text, "an integer");
  } else if (auto* flag = std::get_if<bool*>(&field.value)) {
    if (!absl::SimpleAtob(text, *flag)) return Malformed(field, text, "true or false");
  } else {
    *std::get<std::string*>(field.value) = text;
  }
  return CheckRange(field);
}

size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

Field Number(std::string name, double* value, double low, double high) {
  return {std::move(name), value, low, high, {}};
}
Field Number(std::string name, int* value, int low, int high) {
  return {std::move(name), value, static_cast<double>(low), static_cast<double>(high), {}};
}
Field Number(std::string name, int64_t* value, int64_t low, int64_t high) {
  return {std::move(name), value, static_cast<double>(low), static_cast<double>(high), {}};
}
Field Flag(std::string name, bool* value) { return {std::move(name), value, 0, 1, {}}; }
Field Text(std::string name, std::string* value, std::vector<std::string> choices) {
  return {std::move(name), value, 0, 0, std::move(choices)};
}

std::vector<Field> Nested(std::string_view prefix, std::vector<Field> fields) {
  for (Field& field : fields) field.name = fmt::format("{}.{}", prefix, field.name);
  return fields;
}

void Append(std::vector<Field>& to, std::vector<Field> more) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::string NearestName(std::string_view name, const std::vector<std::string>& candidates) {
  std::string nearest;
  size_t best = std::max<size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = EditDistance(name, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

Status ApplyOverrides(const Overrides& overrides, std::vector<Field> fields) {
  for (const auto& [key, text] : overrides) {
    const auto found =
        std::find_if(fields.begin(), fields.end(),
                     [&name = key](const Field& field) { return field.name == name; });
    if (found == fields.end()) {
      std::vector<std::string> names;
      for (const Field& field : fields) names.push_back(field.name);
      const std::string nearest = NearestName(key, names);
      return InvalidArgument(
          "UNKNOWN_CONFIG_KEY", key,
          fmt::format("unknown setting '{}'{}", key,
                      nearest.empty() ? fmt::format("; known settings: {}", fmt::join(names, ", "))
                                      : fmt::format("; did you mean '{}'?", nearest)));
    }
    POISE_RETURN_IF_ERROR(SetFromText(*found, text));
  }
  return absl::OkStatus();
}

Status CheckRanges(const std::vector<Field>& fields) {
  for (const Field& field : fields) POISE_RETURN_IF_ERROR(CheckRange(field));
  return absl::OkStatus();
}

Json FieldsToJson(const std::vector<Field>& fields) {
  Json json = Json::object();
  for (const Field& field : fields) {
    std::visit([&](auto* value) { json[field.name] = *value; }, field.value);
  }
  return json;
}

Status FieldsFromJson(const Json& json, std::vector<Field> fields) {
  if (!json.is_object()) {
    return InvalidArgument("MALFORMED_CONFIG_VALUE", "", "a config must be a JSON object");
  }
  Overrides overrides;
  for (const auto& [key, value] : json.items()) {
    overrides[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return ApplyOverrides(overrides, std::move(fields));
}

}  // namespace poise::base
