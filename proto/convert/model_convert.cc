#include "proto/convert/model_convert.h"

#include <utility>

#include "proto/convert/struct_convert.h"

namespace poise::convert {

v1::MotionSignature ToProto(const motion::MotionSignature& signature) {
  v1::MotionSignature message;
  for (const motion::JointRole role : signature.roles) message.add_roles(motion::RoleName(role));
  message.set_rotation(motion::RotationRepresentationName(signature.rotation));
  message.set_root_position(signature.with_root_position);
  message.set_frame_rate(signature.frame_rate);
  return message;
}

StatusOr<motion::MotionSignature> FromProto(const v1::MotionSignature& message) {
  return motion::SignatureFromJson(
      {{"roles", std::vector<std::string>(message.roles().begin(), message.roles().end())},
       {"rotation", message.rotation()},
       {"root_position", message.root_position()},
       {"frame_rate", message.frame_rate()}});
}

v1::ModelCard ToProto(const api::ModelCard& card) {
  v1::ModelCard message;
  message.set_family(card.family);
  message.set_preset(card.preset);
  *message.mutable_config() = ToProto(card.config);
  *message.mutable_signature() = ToProto(card.signature);
  *message.mutable_normalisation() = ToProto(card.normalisation);
  message.set_data(card.data);
  message.set_data_fingerprint(card.data_fingerprint);
  message.set_trained_on(card.trained_on);
  message.set_data_license(card.data_license);
  message.set_seed(card.seed);
  message.set_steps(card.steps);
  message.mutable_scores()->insert(card.scores.begin(), card.scores.end());
  message.set_program_version(card.program_version);
  message.set_weights_sha256(card.weights_sha256);
  return message;
}

StatusOr<api::ModelCard> FromProto(const v1::ModelCard& message) {
  api::ModelCard card;
  card.family = message.family();
  card.preset = message.preset();
  POISE_ASSIGN_OR_RETURN(card.config, FromProto(message.config(), "card.config"));
  POISE_ASSIGN_OR_RETURN(card.signature, FromProto(message.signature()));
  POISE_ASSIGN_OR_RETURN(card.normalisation,
                         FromProto(message.normalisation(), "card.normalisation"));
  card.data = message.data();
  card.data_fingerprint = message.data_fingerprint();
  card.trained_on = message.trained_on();
  card.data_license = message.data_license();
  card.seed = message.seed();
  card.steps = message.steps();
  card.scores = {message.scores().begin(), message.scores().end()};
  card.program_version = message.program_version();
  card.weights_sha256 = message.weights_sha256();
  return card;
}

v1::Model ToProto(const api::Model& model) {
  v1::Model message;
  message.set_name(model.name);
  message.set_version(model.version);
  *message.mutable_card() = ToProto(model.card);
  message.set_size_bytes(model.size_bytes);
  message.set_default_(model.is_default);
  message.set_shipped(model.shipped);
  return message;
}

StatusOr<api::Model> FromProto(const v1::Model& message) {
  api::Model model;
  model.name = message.name();
  model.version = message.version();
  POISE_ASSIGN_OR_RETURN(model.card, FromProto(message.card()));
  model.size_bytes = message.size_bytes();
  model.is_default = message.default_();
  model.shipped = message.shipped();
  return model;
}

}  // namespace poise::convert
