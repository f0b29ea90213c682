#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench/bench_clip.h"
#include "bench/benchmark.h"
#include "core/correction/reward.h"
#include "core/physics/bullet_engine.h"
#include "core/physics/world.h"
#ifdef POISE_HAVE_MUJOCO
#include "bench/mujoco_humanoid.h"
#endif

/// How many control steps of 1/30 s one thread simulates in a second: the humanoid with 51 degrees
/// of freedom tracks swinging targets with its residual wrench, gets its reward after each step,
/// and starts anew every 60 steps, so that it stands, staggers and lies.
namespace poise::bench {
namespace {

using physics::Vec3;

constexpr int kStepsPerRun = 60;
constexpr int kUpdatesPerControlStep = 20;  // 600 Hz
constexpr double kRequiredWithSelfCollision = 1200;
constexpr double kRequiredWithout = 1300;
constexpr double kRequiredAtAuthorsRates = 750;

physics::HumanoidModelPtr Model() {
  const motion::Clip clip = CapturedSizeClip(120, 120);
  const motion::JointRoles roles = *motion::JointRoles::Detect(*clip.skeleton());
  physics::HumanoidConfig config;
  config.fixed_wrists = false;
  return *physics::HumanoidModel::Create(clip, roles, config);
}

physics::State Start() {
  physics::State state;
  state.root_position = Vec3(0, 0.95, 0);
  return state;
}

physics::Drive DriveAt(const physics::HumanoidModel& model, int step) {
  physics::Drive drive;
  drive.residual = model.residual_gains();
  drive.target_root = Start().root_position;
  for (int i = 1; i < physics::kMaxBodies; ++i) {
    const double phase = 0.1 * step + i;
    drive.target_rotations[i] =
        math::FromRotationVector(Vec3(0.3 * std::sin(phase), 0.15 * std::sin(1.3 * phase), 0.1));
  }
  return drive;
}

// Runs the body over and over; each call is one control step.
class TrackedWorld {
 public:
  TrackedWorld(const physics::HumanoidModel& model, const physics::WorldConfig& config)
      : model_(model),
        world_(std::move(physics::World::Create(model.articulation(), config)).value()) {}

  void ControlStep() {
    if (step_ % kStepsPerRun == 0) world_.Reset(Start());
    const physics::Drive drive = DriveAt(model_, step_++ % kStepsPerRun);
    for (int update = 0; update < kUpdatesPerControlStep; ++update) world_.Step(drive);
    const correction::Reward reward = correction::ComputeReward(
        model_, {}, correction::ComputeFeatures(model_, world_.state()), wanted_,
        world_.effort().residual_force, world_.effort().residual_torque);
    if (!std::isfinite(reward.total)) std::abort();
  }

 private:
  const physics::HumanoidModel& model_;
  physics::World world_;
  correction::Features wanted_ = correction::ComputeFeatures(model_, Start());
  int step_ = 0;
};

double Rate(const physics::HumanoidModel& model, const physics::WorldConfig& config) {
  TrackedWorld tracked(model, config);
  return MeasureRate([&] { tracked.ControlStep(); });
}

// Two threads at once, by the clock on the wall.
double RateOfTwo(const physics::HumanoidModel& model, const physics::WorldConfig& config) {
  constexpr int kSteps = 8000;
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&] {
      TrackedWorld tracked(model, config);
      for (int step = 0; step < kSteps; ++step) tracked.ControlStep();
    });
  }
  for (std::thread& thread : threads) thread.join();
  return 2 * kSteps /
         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Bullet alone, without motors: what any controller on top of it pays first.
double LimpBulletRate(const physics::HumanoidModel& model, bool self_collision) {
  physics::StepSettings settings;
  settings.self_collision = self_collision;
  physics::BulletEngine bullet(model.articulation(), settings);
  const double none[physics::kMaxSpeeds] = {};
  physics::StepState state;
  int step = 0;
  return MeasureRate([&] {
    if (step++ % kStepsPerRun == 0) {
      state = physics::StepState();
      for (int i = 0; i < physics::kMaxBodies; ++i) state.rotations[4 * i + 3] = 1;
      state.root_position[1] = Start().root_position.y();
      bullet.Reset(state);
    }
    for (int update = 0; update < kUpdatesPerControlStep; ++update) bullet.Advance(none, state);
  });
}

#ifdef POISE_HAVE_MUJOCO
double MujocoRate(const physics::HumanoidModel& model, const MujocoHumanoid::Options& options) {
  MujocoHumanoid body(model.articulation(), options);
  int step = 0;
  return MeasureRate([&] {
    if (step % kStepsPerRun == 0) body.Reset(Start());
    body.Advance(DriveAt(model, step++ % kStepsPerRun), kUpdatesPerControlStep);
    if (!body.Finite()) std::abort();
  });
}
#endif

}  // namespace

std::vector<Row> RunSimBenchmark() {
  const physics::HumanoidModelPtr model = Model();
  physics::WorldConfig with, without, authors;
  without.self_collision = false;
  authors.substeps = 2;
  const auto bullet = [](physics::WorldConfig config) {
    config.engine = "bullet";
    return config;
  };
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, double rate, const std::string& peer,
                       double peer_rate, int threads = 1) {
    rows.push_back({"sim/" + name, rate, "control steps/s", peer, rate / peer_rate, threads});
  };
  const double own = Rate(*model, with);
  add("own_600Hz_self_collision", own, "1200 required", kRequiredWithSelfCollision);
  add("own_600Hz", Rate(*model, without), "1300 required", kRequiredWithout);
  add("own_600Hz_1200Hz", Rate(*model, authors), "750 required", kRequiredAtAuthorsRates);
  add("own_two_threads", RateOfTwo(*model, with), "one thread", own, 2);
  add("bullet_600Hz_self_collision", Rate(*model, bullet(with)), "1200 required",
      kRequiredWithSelfCollision);
  add("bullet_600Hz", Rate(*model, bullet(without)), "1300 required", kRequiredWithout);
  add("bullet_600Hz_1200Hz", Rate(*model, bullet(authors)), "750 required",
      kRequiredAtAuthorsRates);
  const double limp = LimpBulletRate(*model, true);
  add("own_vs_limp_bullet", own, "Bullet without motors", limp);
#ifdef POISE_HAVE_MUJOCO
  add("own_vs_mujoco_newton", own, "MuJoCo, Newton", MujocoRate(*model, {.solver = "Newton"}));
  add("own_vs_mujoco_pgs", own, "MuJoCo, PGS", MujocoRate(*model, {.solver = "PGS"}));
#endif
  return rows;
}

}  // namespace poise::bench
