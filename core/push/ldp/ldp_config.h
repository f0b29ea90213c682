#ifndef POISE_CORE_PUSH_LDP_LDP_CONFIG_H_
#define POISE_CORE_PUSH_LDP_LDP_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/push/training/push_training_config.h"

/// Latent differentiable physics (LDP): the method of "Human Motion Prediction under Unexpected
/// Perturbation" (Yue et al., CVPR 2024), as preset `paper`. Defaults are the paper's values, or
/// its program's where the paper is silent; where both are unusable or unaffordable the comment
/// says "ours". Source: reference push.md sec. 4 to 10.
namespace poise::push::ldp {

/// The preset of this method, and what the card of its models has as family.
inline constexpr const char* kPreset = "paper";
inline constexpr const char* kFamily = "push-ldp";

/// How a person balances (sec. 4.2, 4.3): PD control, the self network, friction and the rod.
struct BalanceConfig {
  int self_input = 32;       ///< [1 to 4096] units before the LSTM
  int self_hidden = 256;     ///< [1 to 4096] of the LSTM
  double self_scale = 10;    ///< [N or N m, 0 to 1000] force of one unit of output
  double speed_gain = 30;    ///< [N s/m] PD on the cart's speed
  double speed_rate = 4;     ///< [N s/m] on its change in a frame
  double lean_gain = 1500;   ///< [N m/rad] PD on both angles
  double lean_rate = 200;    ///< [N m/rad] on their change in a frame
  double friction = 100;     ///< [N s/m, 0 to 10000] at first; learned
  int rod_hidden = 128;      ///< [1 to 4096] units of two layers; the program: 256, 128, 256
  double rod_change = 0.01;  ///< [m, 0 to 1] largest change in a frame
  /// [kg and N or N m, 1 to 1000] Ours: unit of masses and forces as inputs. The paper's is 1,
  /// which saturates LSTM and rod network from the start (its rods fall to the shortest).
  double input_unit = 100;
  double rod_shortest = 0.871;  ///< [m, 0.1 to 3]
  double rod_longest = 1.075;   ///< [m, 0.1 to 3]
  /// Ours: gradients go back through the LSTM's memory. The paper's do not, so that its memory is
  /// not taught to tell a push that goes on from one that is over.
  bool memory_gradient = true;
  /// While somebody alone is pushed, the push is the only force, as in the program for one person.
  bool push_alone = true;
  /// Ours: nobody acts before a push or a neighbour acts on them. Without it the PD control sways
  /// people who nobody has touched; the program hides that by freezing their poses.
  bool wait = true;

  std::vector<base::Field> Fields();
};

/// What people do to each other (sec. 5).
struct InteractionConfig {
  int hidden = 512;           ///< [1 to 4096] units of two layers
  double reach_m = 0.5;       ///< [m, 0.1 to 10] distance of carts of neighbours
  double moving_speed = 0.1;  ///< [m/s, 0 to 10] neighbours act above it; the paper does not ask
  double potential = 150;     ///< [N m, 0 to 10000] that pushes carts apart
  double potential_m = 0.5;   ///< [m, 0.01 to 10] its range
  double theta_torque = 100;  ///< [N m, 0 to 10000] of the angular table
  double phi_torque = 50;     ///< [N m, 0 to 10000]; the program: 100
  double upright = 0.1;       ///< [rad, 0 to 1] angles below count as zero
  bool learned = true;        ///< false: an ablation without the network
  bool basic = true;          ///< false: an ablation without potential and table

  std::vector<base::Field> Fields();
};

/// How pendulums become bodies (sec. 6 to 8).
struct BodyConfig {
  /// low_up: legs first, then the rest | full: one model of the whole body.
  std::string parts = "low_up";
  int latent = 64;            ///< [1 to 1024]
  int hidden = 256;           ///< [1 to 4096] of encoder, sampler and decoder
  int gate_hidden = 64;       ///< [1 to 4096] of the mixture's gate
  int experts = 4;            ///< [1 to 64]
  double onset_speed = 0.15;  ///< [m/s, 0 to 10] of the cart in two frames: the body begins to move

  std::vector<base::Field> Fields();
};

/// Training of the pendulums on whole roll-outs (sec. 4.5, 5.6). Ours: batches of takes and a
/// cosine instead of 500 epochs of single takes (16,000 updates) at 3e-4.
struct PendulumTraining {
  NetworkTraining network = {.steps = 2500,
                             .batch_size = 8,
                             .learning_rate = 2e-3,
                             .weight_decay = 0,
                             .validate_every = 20};
  int first_frames = 30;         ///< [> 1] ours: length of roll-outs at first
  double growing_share = 0.4;    ///< [0 to 1] ours: of the steps in which they grow to all frames
  double phi_rate_weight = 0.3;  ///< [0 to 10] of the last term
  double rod_weight = 1;         ///< [0 to 100] ours, the paper has none and its rods degenerate
  double hip_weight = 5;         ///< [0 to 100] ours, of the rod end's distance [m] from the hip

  std::vector<base::Field> Fields();
};

/// Training of a CVAE or of a sampler (sec. 7, 8). Ours: one update a roll-out, not one a frame,
/// and fewer of them (the paper's 140 and 100 epochs are some 150,000 updates each).
struct BodyTraining {
  NetworkTraining network = {.steps = 600,
                             .batch_size = 64,
                             .learning_rate = 1e-3,
                             .weight_decay = 0,
                             .validate_every = 100};
  int rollout = 16;             ///< [frames, 1 to 1000] the paper: 8 or 32
  double kl_weight = 0.005;     ///< [0 to 10] CVAEs only
  double teacher_share = 0.14;  ///< [0 to 1] CVAEs: first share of steps with recorded conditions
  double ramp_share = 0.14;     ///< [0 to 1] CVAEs: then it falls to none
  double latent_weight = 1;     ///< [0 to 100] samplers: to the encoder's distribution
  double reconstruction_weight = 1;  ///< [0 to 100] samplers: as the program for one person has it
  double foot_weight = 0.1;          ///< [0 to 100] samplers of legs: FSE (eq. 7, no weight stated)

  std::vector<base::Field> Fields();
};

/// Training of everything together: stated by the paper, without a schedule. Ours.
struct EndToEndTraining {
  NetworkTraining network = {
      .steps = 80, .batch_size = 8, .learning_rate = 2e-4, .weight_decay = 0, .validate_every = 10};
  int rounds = 1;  ///< [0 to 100] each with the cosine anew, from the best step of the one before
  double joint_weight = 10;  ///< [0 to 1000] of the mean joint error [m] beside the pendulum's loss

  std::vector<base::Field> Fields();
};

/// The whole method. Ablations of the paper: `pendulum` and `body.parts`.
struct LdpTraining {
  std::string protocol = "A";  ///< A, B or C: what is told of a push
  /// false: no pendulums and samplers; bodies go from latents drawn at random.
  bool pendulum = true;
  BalanceConfig balance;
  InteractionConfig interaction;
  BodyConfig body;
  PendulumTraining balance_training;
  PendulumTraining interaction_training = {.network = {.steps = 150,
                                                       .batch_size = 8,
                                                       .learning_rate = 1e-3,
                                                       .weight_decay = 0,
                                                       .validate_every = 15},
                                           .rod_weight = 0};
  BodyTraining cvae_training;
  BodyTraining sampler_training;
  EndToEndTraining end_to_end;

  /// "paper". Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<LdpTraining> FromPreset(std::string_view name);
  std::vector<base::Field> Fields();
  Status Validate();
};

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_LDP_CONFIG_H_
