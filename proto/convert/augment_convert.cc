#include "proto/convert/augment_convert.h"

#include <fmt/format.h>

#include <utility>

#include "proto/convert/clip_convert.h"
#include "proto/convert/plausibility_convert.h"
#include "proto/convert/utf8.h"

namespace poise::convert {
namespace {

// Everything but the sources.
StatusOr<api::AugmentSpec> FromScalars(const v1::AugmentRequest& request) {
  api::AugmentSpec spec;
  if (!request.method().empty()) spec.method = request.method();
  if (!request.action_class().empty()) spec.action_class = request.action_class();
  if (!request.preset().empty()) spec.preset = request.preset();
  spec.model = request.model();
  if (request.variants_per_source() != 0) spec.variants_per_source = request.variants_per_source();
  spec.seed = request.seed();
  spec.overrides.insert(request.overrides().begin(), request.overrides().end());
  spec.with_plausibility = !request.skip_plausibility();
  POISE_ASSIGN_OR_RETURN(spec.output, convert::FromProto(request.output()));
  return spec;
}

}  // namespace

v1::OutputEncoding ToProto(api::OutputEncoding output) {
  return output == api::OutputEncoding::kBvh ? v1::OUTPUT_ENCODING_BVH : v1::OUTPUT_ENCODING_ARRAYS;
}

StatusOr<api::OutputEncoding> FromProto(v1::OutputEncoding output) {
  switch (output) {
    case v1::OUTPUT_ENCODING_UNSPECIFIED:
    case v1::OUTPUT_ENCODING_ARRAYS:
      return api::OutputEncoding::kArrays;
    case v1::OUTPUT_ENCODING_BVH:
      return api::OutputEncoding::kBvh;
    default:
      return base::InvalidArgument(
          "UNKNOWN_OUTPUT", "output",
          fmt::format("output encoding {} is not known to this server", static_cast<int>(output)));
  }
}

v1::AugmentRequest ToProto(const api::AugmentSpec& spec) {
  v1::AugmentRequest message;
  for (const api::ClipSource& source : spec.sources) *message.add_sources() = ToProto(source);
  message.set_method(ValidUtf8(spec.method));
  message.set_action_class(ValidUtf8(spec.action_class));
  message.set_preset(ValidUtf8(spec.preset));
  message.set_model(ValidUtf8(spec.model));
  message.set_variants_per_source(spec.variants_per_source);
  message.set_seed(spec.seed);
  for (const auto& [key, value] : spec.overrides) {
    (*message.mutable_overrides())[ValidUtf8(key)] = ValidUtf8(value);
  }
  message.set_skip_plausibility(!spec.with_plausibility);
  message.set_output(ToProto(spec.output));
  return message;
}

StatusOr<api::AugmentSpec> FromProto(const v1::AugmentRequest& request) {
  // The cheap checks come first: a thousand clips are not converted only to be refused.
  if (request.sources_size() > api::AugmentSpec::kMaxSources) {
    return base::InvalidArgument(
        "TOO_MANY_SOURCES", "sources",
        fmt::format("request has {} sources, at most {}", request.sources_size(),
                    api::AugmentSpec::kMaxSources));
  }
  POISE_ASSIGN_OR_RETURN(api::AugmentSpec spec, FromScalars(request));
  spec.sources.reserve(request.sources_size());
  for (int i = 0; i < request.sources_size(); ++i) {
    StatusOr<api::ClipSource> source = convert::FromProto(request.sources(i));
    if (!source.ok()) {
      const std::string field = fmt::format("sources[{}]", i);
      return base::Annotate(source.status(), field, field);
    }
    spec.sources.push_back(*std::move(source));
  }
  POISE_RETURN_IF_ERROR(spec.Validate());
  return spec;
}

v1::IkOutcome ToProto(const api::IkOutcome& outcome) {
  v1::IkOutcome message;
  message.set_end_effector(motion::RoleName(outcome.end_effector));
  message.set_keyframe(outcome.keyframe);
  *message.mutable_target() = ToProto(outcome.target);
  message.set_reached_error_m(outcome.reached_error_m);
  message.set_reachable(outcome.reachable);
  return message;
}

StatusOr<api::IkOutcome> FromProto(const v1::IkOutcome& outcome) {
  const std::optional<motion::JointRole> role = motion::ParseRole(outcome.end_effector());
  if (!role) {
    return base::InvalidArgument("UNKNOWN_ROLE", "end_effector",
                                 fmt::format("'{}' is no joint role", outcome.end_effector()));
  }
  return api::IkOutcome{.end_effector = *role,
                        .keyframe = outcome.keyframe(),
                        .target = FromProto(outcome.target()),
                        .reached_error_m = outcome.reached_error_m(),
                        .reachable = outcome.reachable()};
}

v1::AugmentResponse ToProto(const api::DeliveredVariant& variant) {
  v1::AugmentResponse message;
  message.set_source_index(variant.source_index);
  message.set_index(variant.index);
  message.set_seed(variant.seed);
  if (const auto* clip = std::get_if<motion::Clip>(&variant.result)) {
    *message.mutable_clip() = ToProto(*clip);
  } else if (const auto* file = std::get_if<api::EncodedClip>(&variant.result)) {
    *message.mutable_file() = ToProto(*file);
  } else {
    message.set_artifact(std::get<std::string>(variant.result));
  }
  if (variant.ik) *message.mutable_ik() = ToProto(*variant.ik);
  if (variant.plausibility) *message.mutable_plausibility() = ToProto(*variant.plausibility);
  return message;
}

StatusOr<api::DeliveredVariant> FromProto(const v1::AugmentResponse& response) {
  // A placeholder result: a Clip cannot be empty.
  api::DeliveredVariant variant{.source_index = response.source_index(),
                                .index = response.index(),
                                .seed = response.seed(),
                                .result = response.artifact(),
                                .ik = std::nullopt,
                                .plausibility = std::nullopt};
  switch (response.result_case()) {
    case v1::AugmentResponse::kClip: {
      POISE_ASSIGN_OR_RETURN(variant.result, convert::FromProto(response.clip()));
      break;
    }
    case v1::AugmentResponse::kFile: {
      POISE_ASSIGN_OR_RETURN(variant.result, convert::FromProto(response.file()));
      break;
    }
    case v1::AugmentResponse::kArtifact:
      break;
    case v1::AugmentResponse::RESULT_NOT_SET:
      return base::InvalidArgument("EMPTY_RESULT", "result", "the response holds no variant");
  }
  if (response.has_ik()) {
    POISE_ASSIGN_OR_RETURN(variant.ik, FromProto(response.ik()));
  }
  if (response.has_plausibility()) {
    variant.plausibility = convert::FromProto(response.plausibility());
  }
  return variant;
}

}  // namespace poise::convert
