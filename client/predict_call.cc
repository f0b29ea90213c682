// What Client asks of PredictionService.
#include <algorithm>

#include "client/client.h"
#include "client/connection.h"
#include "core/motion/editing/cut.h"
#include "proto/convert/predict_convert.h"

namespace poise::client {
namespace {

// The end of a long clip: what lies further back has no say in its future.
Status KeepLastSeconds(motion::Clip& clip, motion::JointMask& visible) {
  const double most = absl::ToDoubleSeconds(Client::kMaxPast) * clip.frame_rate() + 1;
  if (clip.num_frames() <= most) return absl::OkStatus();
  const int kept = std::max(1, static_cast<int>(most));
  const int first = clip.num_frames() - kept;
  if (visible.visible.size() == clip.rotations().size()) {
    visible.visible.erase(visible.visible.begin(),
                          visible.visible.begin() + int64_t{first} * clip.num_joints());
  }
  POISE_ASSIGN_OR_RETURN(clip, motion::Cut(clip, first, kept));
  return absl::OkStatus();
}

}  // namespace

StatusOr<api::Forecast> Client::Predict(api::PredictQuery query) {
  POISE_RETURN_IF_ERROR(query.Validate());
  if (auto* clip = std::get_if<motion::Clip>(&query.source.clip)) {
    POISE_RETURN_IF_ERROR(KeepLastSeconds(*clip, query.visible));
  }
  const auto context = connection_->NewCall();
  v1::PredictResponse response;
  POISE_RETURN_IF_ERROR(connection_->Explain(
      connection_->prediction().Predict(context.get(), convert::ToProto(query), &response)));
  return convert::FromProto(response);
}

}  // namespace poise::client
