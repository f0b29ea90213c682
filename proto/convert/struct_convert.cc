#include "proto/convert/struct_convert.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "proto/convert/utf8.h"

namespace poise::convert {
namespace {

/// Beyond it a double does not hold every whole number.
constexpr double kMaxExactInteger = 9007199254740992.0;

google::protobuf::Value ToValue(const base::Json& json) {
  google::protobuf::Value value;
  switch (json.type()) {
    case base::Json::value_t::object:
      for (const auto& [key, item] : json.items()) {
        (*value.mutable_struct_value()->mutable_fields())[ValidUtf8(key)] = ToValue(item);
      }
      value.mutable_struct_value();
      break;
    case base::Json::value_t::array:
      for (const base::Json& item : json) {
        *value.mutable_list_value()->add_values() = ToValue(item);
      }
      value.mutable_list_value();
      break;
    case base::Json::value_t::string:
      value.set_string_value(ValidUtf8(json.get_ref<const std::string&>()));
      break;
    case base::Json::value_t::boolean:
      value.set_bool_value(json.get<bool>());
      break;
    case base::Json::value_t::number_integer:
    case base::Json::value_t::number_unsigned:
    case base::Json::value_t::number_float:
      value.set_number_value(json.get<double>());
      break;
    default:
      value.set_null_value(google::protobuf::NULL_VALUE);
  }
  return value;
}

StatusOr<base::Json> FromValue(const google::protobuf::Value& value, const std::string& field) {
  switch (value.kind_case()) {
    case google::protobuf::Value::kStructValue:
      return convert::FromProto(value.struct_value(), field);
    case google::protobuf::Value::kListValue: {
      base::Json json = base::Json::array();
      for (int i = 0; i < value.list_value().values_size(); ++i) {
        POISE_ASSIGN_OR_RETURN(base::Json item, FromValue(value.list_value().values(i),
                                                          fmt::format("{}[{}]", field, i)));
        json.push_back(std::move(item));
      }
      return json;
    }
    case google::protobuf::Value::kStringValue:
      return base::Json(value.string_value());
    case google::protobuf::Value::kBoolValue:
      return base::Json(value.bool_value());
    case google::protobuf::Value::kNumberValue: {
      const double number = value.number_value();
      if (!std::isfinite(number)) {
        return base::InvalidArgument("NOT_FINITE", field,
                                     fmt::format("{} is not a finite number", field));
      }
      if (number == std::trunc(number) && std::abs(number) <= kMaxExactInteger) {
        return base::Json(static_cast<int64_t>(number));
      }
      return base::Json(number);
    }
    default:
      return base::Json(nullptr);
  }
}

}  // namespace

google::protobuf::Struct ToProto(const base::Json& object) {
  return ToValue(object).struct_value();
}

StatusOr<base::Json> FromProto(const google::protobuf::Struct& message, const std::string& field) {
  // The wire's map has no order; ours is by key, so that equal requests look equal.
  const std::map<std::string, google::protobuf::Value> sorted(message.fields().begin(),
                                                              message.fields().end());
  base::Json json = base::Json::object();
  for (const auto& [key, item] : sorted) {
    POISE_ASSIGN_OR_RETURN(json[key], FromValue(item, field + "." + key));
  }
  return json;
}

}  // namespace poise::convert
