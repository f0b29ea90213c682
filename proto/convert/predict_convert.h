#ifndef POISE_PROTO_CONVERT_PREDICT_CONVERT_H_
#define POISE_PROTO_CONVERT_PREDICT_CONVERT_H_

#include "core/api/predict_query.h"
#include "core/base/status.h"
#include "poise/v1/prediction.pb.h"

namespace poise::convert {

v1::PredictRequest ToProto(const api::PredictQuery& query);
/// Absent fields take the defaults of PredictQuery. Errors: those of PredictQuery::Validate and of
/// the source (field "source.clip.rotations"), kInvalidArgument UNKNOWN_OUTPUT.
StatusOr<api::PredictQuery> FromProto(const v1::PredictRequest& request);

v1::PredictResponse ToProto(const api::Forecast& forecast);
/// Errors: those of the clips.
StatusOr<api::Forecast> FromProto(const v1::PredictResponse& response);

v1::PredictStreamSetup ToProto(const api::ForecastStreamSpec& spec);
/// Errors: those of Skeleton::Create and ForecastStreamSpec::Validate.
StatusOr<api::ForecastStreamSpec> FromProto(const v1::PredictStreamSetup& setup);

/// Frames of a stream as a clip, and back. Errors: those of FromProto of a Clip.
StatusOr<motion::Clip> FromProto(const v1::ObservedFrames& frames, motion::SkeletonPtr skeleton,
                                 double frame_rate);
v1::ObservedFrames ToObservedFrames(const motion::Clip& clip);
/// Adds the clip's arrays.
void WriteFuture(const motion::Clip& future, v1::PredictStreamResponse& response);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_PREDICT_CONVERT_H_
