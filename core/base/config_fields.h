#ifndef POISE_CORE_BASE_CONFIG_FIELDS_H_
#define POISE_CORE_BASE_CONFIG_FIELDS_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "core/base/status.h"

/// One list of fields per config struct drives its JSON, its overrides from requests and flags, its
/// range checks and its unknown-key errors:
///
///   struct FabrikConfig {
///     double tolerance = 1e-4;  ///< [m, > 0] ...
///     std::vector<base::Field> Fields() {
///       return {base::Number("tolerance", &tolerance, 1e-9, 1e-1)};
///     }
///     Status Validate() const;   // what ranges cannot say
///   };
namespace poise::base {

/// One named value inside a config struct, with the closed range that it may take.
struct Field {
  std::string name;
  std::variant<double*, int*, int64_t*, bool*, std::string*> value;
  double low = 0;
  double high = 0;
  std::vector<std::string> choices;  ///< of a string field; empty = any text
};

Field Number(std::string name, double* value, double low, double high);
Field Number(std::string name, int* value, int low, int high);
Field Number(std::string name, int64_t* value, int64_t low, int64_t high);
Field Flag(std::string name, bool* value);
Field Text(std::string name, std::string* value, std::vector<std::string> choices = {});

/// Puts `prefix` + "." before each name: how a struct lists the fields of one inside it.
std::vector<Field> Nested(std::string_view prefix, std::vector<Field> fields);
void Append(std::vector<Field>& to, std::vector<Field> more);

/// Key-value pairs as they come from a request or from flags.
using Overrides = std::map<std::string, std::string>;

/// Sets the named fields. Errors: kInvalidArgument, with the key as the field:
/// UNKNOWN_CONFIG_KEY (the message names the nearest known key), MALFORMED_CONFIG_VALUE,
/// CONFIG_VALUE_OUT_OF_RANGE. On error some fields may already be set.
Status ApplyOverrides(const Overrides& overrides, std::vector<Field> fields);

/// Checks every value against its range. Errors: CONFIG_VALUE_OUT_OF_RANGE.
Status CheckRanges(const std::vector<Field>& fields);

/// {"tolerance": 1e-4, ...} in the order of the list.
Json FieldsToJson(const std::vector<Field>& fields);

/// Sets the fields named in `json` (an object of scalars). Errors: as ApplyOverrides.
Status FieldsFromJson(const Json& json, std::vector<Field> fields);

/// The candidate with the smallest edit distance to `name`, or empty when none is close.
std::string NearestName(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace poise::base

#endif  // POISE_CORE_BASE_CONFIG_FIELDS_H_
