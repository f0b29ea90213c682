#include "core/prediction/predictor_registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/prediction/constant_velocity/constant_velocity.h"
#include "core/prediction/ensemble/ensemble_predictor.h"
#include "core/prediction/gcn/gcn_predictor.h"
#include "core/prediction/mixer/mixer_predictor.h"
#include "core/prediction/potr/potr_predictor.h"
#include "core/prediction/rnn/rnn_predictor.h"
#include "core/prediction/simlpe/simlpe_predictor.h"
#include "core/prediction/training/training_config.h"
#include "core/prediction/zero_velocity/zero_velocity.h"

namespace poise::prediction {
namespace {

template <typename Family>
PredictorPtr Make() {
  return std::make_shared<Family>();
}

// Sizes of a family, and the predictor that is made of them.
template <typename Made, auto kSizes>
StatusOr<PredictorPtr> Load(const PredictorTraining& config, const NetworkBody& body,
                            const base::TensorFile& weights) {
  return Made::Create(config.*kSizes, body, weights);
}

struct Floor {
  const char* name;
  PredictorPtr (*make)();
};

constexpr Floor kFloors[] = {
    {"zero-velocity", Make<ZeroVelocity>},
    {"constant-velocity", Make<ConstantVelocity>},
};

struct Family {
  const char* name;
  StatusOr<PredictorPtr> (*load)(const PredictorTraining& config, const NetworkBody& body,
                                 const base::TensorFile& weights);
};

constexpr Family kFamilies[] = {
    {"mixer", Load<MixerPredictor, &PredictorTraining::mixer>},
    {"gcn", Load<GcnPredictor, &PredictorTraining::gcn>},
    {"rnn", Load<RnnPredictor, &PredictorTraining::rnn>},
    {"potr", Load<PotrPredictor, &PredictorTraining::potr>},
    {"simlpe", Load<SimlpePredictor, &PredictorTraining::simlpe>},
};

StatusOr<const Family*> FindFamily(const std::string& name) {
  std::vector<std::string> names;
  for (const Family& family : kFamilies) {
    if (name == family.name) return &family;
    names.push_back(family.name);
  }
  return base::FailedPrecondition("WRONG_FAMILY", "model",
                                  fmt::format("a model of family '{}' predicts nothing, those of "
                                              "these families do: {}",
                                              name, fmt::join(names, ", ")));
}

base::TensorFile WeightsOfMember(const base::TensorFile& weights, int member) {
  const std::string prefix = fmt::format("member{}.", member);
  base::TensorFile own;
  for (const auto& [name, tensor] : weights.tensors) {
    if (name.starts_with(prefix)) own.tensors[name.substr(prefix.size())] = tensor;
  }
  return own;
}

}  // namespace

std::vector<std::string> BuiltInPredictorNames() {
  std::vector<std::string> names;
  for (const Floor& floor : kFloors) names.push_back(floor.name);
  return names;
}

PredictorPtr FindBuiltInPredictor(std::string_view name) {
  for (const Floor& floor : kFloors) {
    if (name == floor.name) return floor.make();
  }
  return nullptr;
}

StatusOr<PredictorPtr> MakeTrainedPredictor(const artifacts::ModelArtifact& model) {
  POISE_ASSIGN_OR_RETURN(const Family* family, FindFamily(model.card.family));
  PredictorTraining config;
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(model.card.config, config.Fields()));
  POISE_RETURN_IF_ERROR(config.Validate());
  POISE_ASSIGN_OR_RETURN(
      const NetworkBody body,
      NetworkBody::FromJson(model.card.normalisation.value("body", base::Json())));
  if (config.members == 1) return family->load(config, body, model.weights);
  std::vector<PredictorPtr> members;
  for (int i = 0; i < config.members; ++i) {
    POISE_ASSIGN_OR_RETURN(members.emplace_back(),
                           family->load(config, body, WeightsOfMember(model.weights, i)));
  }
  return EnsemblePredictor::Create(std::move(members));
}

}  // namespace poise::prediction
