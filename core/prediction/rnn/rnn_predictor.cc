#include "core/prediction/rnn/rnn_predictor.h"

#include <utility>
#include <vector>

#include "core/base/isa.h"

namespace poise::prediction {

Status RnnPredictor::Load(const RnnConfig& config, const base::TensorFile& weights) {
  RnnArguments& a = arguments_;
  a.columns = columns().count();
  a.past = config.past_frames;
  a.future = config.future_frames;
  a.hidden = config.hidden;
  const int64_t gates = int64_t{3} * config.hidden;
  const auto take = [&](const char* name, std::vector<int64_t> shape) {
    return numbers_.Take(weights, name, std::move(shape));
  };
  POISE_ASSIGN_OR_RETURN(a.input.weight, take("cell.weight_ih", {gates, a.columns}));
  POISE_ASSIGN_OR_RETURN(a.input.bias, take("cell.bias_ih", {gates}));
  POISE_ASSIGN_OR_RETURN(a.state.weight, take("cell.weight_hh", {gates, a.hidden}));
  POISE_ASSIGN_OR_RETURN(a.state.bias, take("cell.bias_hh", {gates}));
  POISE_ASSIGN_OR_RETURN(a.change, numbers_.TakeLinear(weights, "change", a.columns, a.hidden));
  return absl::OkStatus();
}

void (*RnnPredictor::Kernel())(const RnnArguments&) {
  return base::SelectKernel(isa_v2::RnnKernel, isa_v3::RnnKernel, isa_v4::RnnKernel);
}

}  // namespace poise::prediction
