#include "proto/convert/predict_convert.h"

#include <utility>

#include "proto/convert/augment_convert.h"
#include "proto/convert/clip_convert.h"
#include "proto/convert/utf8.h"

namespace poise::convert {

v1::PredictRequest ToProto(const api::PredictQuery& query) {
  v1::PredictRequest message;
  *message.mutable_source() = ToProto(query.source);
  message.set_model(ValidUtf8(query.model));
  message.set_horizon_s(query.horizon_s);
  if (!query.visible.empty()) {
    const std::vector<bool>& visible = query.visible.visible;
    message.mutable_visible()->mutable_visible()->Add(visible.begin(), visible.end());
  }
  message.set_samples(query.samples);
  message.set_seed(query.seed);
  message.set_output(ToProto(query.output));
  return message;
}

StatusOr<api::PredictQuery> FromProto(const v1::PredictRequest& request) {
  StatusOr<api::ClipSource> source = convert::FromProto(request.source());
  if (!source.ok()) return base::Annotate(source.status(), "source", "source");
  api::PredictQuery query{.source = *std::move(source)};
  if (!request.model().empty()) query.model = request.model();
  if (request.horizon_s() != 0) query.horizon_s = request.horizon_s();
  query.visible.visible.assign(request.visible().visible().begin(),
                               request.visible().visible().end());
  if (request.samples() != 0) query.samples = request.samples();
  query.seed = request.seed();
  POISE_ASSIGN_OR_RETURN(query.output, convert::FromProto(request.output()));
  POISE_RETURN_IF_ERROR(query.Validate());
  return query;
}

v1::PredictResponse ToProto(const api::Forecast& forecast) {
  v1::PredictResponse message;
  message.set_model(ValidUtf8(forecast.model));
  message.set_version(ValidUtf8(forecast.version));
  message.mutable_frame_times_s()->Add(forecast.frame_times_s.begin(),
                                       forecast.frame_times_s.end());
  for (const auto& future : forecast.futures) {
    if (const auto* clip = std::get_if<motion::Clip>(&future)) {
      *message.add_clips() = ToProto(*clip);
    } else {
      *message.add_files() = ToProto(std::get<api::EncodedClip>(future));
    }
  }
  message.set_deterministic(forecast.deterministic);
  message.set_inpainted(forecast.inpainted);
  return message;
}

StatusOr<api::Forecast> FromProto(const v1::PredictResponse& response) {
  api::Forecast forecast{
      .model = response.model(),
      .version = response.version(),
      .frame_times_s = {response.frame_times_s().begin(), response.frame_times_s().end()},
      .futures = {},
      .deterministic = response.deterministic(),
      .inpainted = response.inpainted()};
  for (const v1::Clip& message : response.clips()) {
    POISE_ASSIGN_OR_RETURN(motion::Clip clip, convert::FromProto(message));
    forecast.futures.emplace_back(std::move(clip));
  }
  for (const v1::EncodedClip& message : response.files()) {
    POISE_ASSIGN_OR_RETURN(api::EncodedClip file, convert::FromProto(message));
    forecast.futures.emplace_back(std::move(file));
  }
  return forecast;
}

v1::PredictStreamSetup ToProto(const api::ForecastStreamSpec& spec) {
  v1::PredictStreamSetup message;
  message.set_model(ValidUtf8(spec.model));
  message.set_horizon_s(spec.horizon_s);
  *message.mutable_skeleton() = ToProto(*spec.skeleton);
  message.set_frame_rate(spec.frame_rate);
  message.mutable_joint_roles()->insert(spec.joint_roles.begin(), spec.joint_roles.end());
  return message;
}

StatusOr<api::ForecastStreamSpec> FromProto(const v1::PredictStreamSetup& setup) {
  api::ForecastStreamSpec spec;
  if (!setup.model().empty()) spec.model = setup.model();
  if (setup.horizon_s() != 0) spec.horizon_s = setup.horizon_s();
  POISE_ASSIGN_OR_RETURN(spec.skeleton, convert::FromProto(setup.skeleton()));
  spec.frame_rate = setup.frame_rate();
  spec.joint_roles.insert(setup.joint_roles().begin(), setup.joint_roles().end());
  POISE_RETURN_IF_ERROR(spec.Validate());
  return spec;
}

StatusOr<motion::Clip> FromProto(const v1::ObservedFrames& frames, motion::SkeletonPtr skeleton,
                                 double frame_rate) {
  return ReadArrays({"stream", std::move(skeleton), frame_rate}, frames.root_positions(),
                    frames.rotations());
}

v1::ObservedFrames ToObservedFrames(const motion::Clip& clip) {
  v1::ObservedFrames message;
  WriteArrays(clip, *message.mutable_root_positions(), *message.mutable_rotations());
  return message;
}

void WriteFuture(const motion::Clip& future, v1::PredictStreamResponse& response) {
  WriteArrays(future, *response.mutable_root_positions(), *response.mutable_rotations());
}

}  // namespace poise::convert
