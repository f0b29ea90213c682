#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "bench/benchmark.h"
#include "bench/measure_rate.h"
#include "bench/policy_loop.h"
#include "bench/tracked_world.h"
#include "core/physics/bullet_engine.h"
#include "core/physics/world.h"
#ifdef POISE_HAVE_MUJOCO
#include "bench/mujoco_humanoid.h"
#endif

/// How many control steps of 1/30 s (tracked_world.h) one thread simulates in a second, without and
/// with a policy and a value network of the paper's size in the loop, and what two threads make.
namespace poise::bench {
namespace {

using physics::Vec3;

constexpr double kRequiredWithSelfCollision = 1200;
constexpr double kRequiredWithout = 1300;
constexpr double kRequiredAtAuthorsRates = 750;
constexpr double kRequiredWithPolicy = 1150;
constexpr int kWorldsOfBatch = 8;

double Rate(const physics::HumanoidModel& model, const physics::WorldConfig& config) {
  TrackedWorld tracked(model, config);
  return MeasureRate([&] { tracked.ControlStep(); });
}

double PolicyRate(const physics::HumanoidModel& model, int num_worlds) {
  PolicyLoop loop(model, {}, num_worlds);
  return num_worlds * MeasureRate([&] { loop.ControlSteps(); });
}

// Control steps per second of several threads together: by the clock on the wall, and by the time
// that each thread computed, which other processes on the machine do not lengthen.
struct Rates {
  double wall = 0, computing = 0;
};

using MakeLoop = std::function<std::function<void()>()>;

// Each thread runs a loop of its own that `make_loop` returns and that makes `steps` control steps
// a call.
Rates ThreadedRates(int num_threads, int steps, const MakeLoop& make_loop) {
  constexpr int kStepsOfThread = 1600;
  std::vector<std::function<void()>> loops;
  for (int i = 0; i < num_threads; ++i) loops.push_back(make_loop());
  std::vector<double> computing(num_threads);
  std::vector<std::thread> threads;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < num_threads; ++i) {
    threads.emplace_back([&, i] {
      const double start = ThreadSeconds();
      for (int done = 0; done < kStepsOfThread; done += steps) loops[i]();
      computing[i] = kStepsOfThread / (ThreadSeconds() - start);
    });
  }
  for (std::thread& thread : threads) thread.join();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  return {num_threads * kStepsOfThread / elapsed.count(),
          std::accumulate(computing.begin(), computing.end(), 0.0)};
}

struct Scaling {
  Rates one, two;  // with so many threads
};

// The best of several rounds, one and two threads in turn.
Scaling MeasureScaling(int steps, const MakeLoop& make_loop) {
  constexpr int kRounds = 8;
  Scaling best;
  const auto keep = [](const Rates& from, Rates& to) {
    to.wall = std::max(to.wall, from.wall);
    to.computing = std::max(to.computing, from.computing);
  };
  for (int round = 0; round < kRounds; ++round) {
    keep(ThreadedRates(1, steps, make_loop), best.one);
    keep(ThreadedRates(2, steps, make_loop), best.two);
  }
  return best;
}

Scaling ScalingOfWorlds(const physics::HumanoidModel& model) {
  return MeasureScaling(1, [&] {
    const auto world = std::make_shared<TrackedWorld>(model, physics::WorldConfig());
    return [world] { world->ControlStep(); };
  });
}

Scaling ScalingOfPolicy(const physics::HumanoidModel& model) {
  return MeasureScaling(kWorldsOfBatch, [&] {
    const auto loop = std::make_shared<PolicyLoop>(model, physics::WorldConfig(), kWorldsOfBatch);
    return [loop] { loop->ControlSteps(); };
  });
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
      state.root_position[1] = TrackedStart().root_position.y();
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
    if (step % kStepsPerRun == 0) body.Reset(TrackedStart());
    body.Advance(TrackedDrive(model, step++ % kStepsPerRun), kUpdatesPerControlStep);
    if (!body.Finite()) std::abort();
  });
}
#endif

}  // namespace

std::vector<Row> RunSimBenchmark() {
  const physics::HumanoidModelPtr model = TrackedModel();
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
  add("own_policy", PolicyRate(*model, 1), "1150 required", kRequiredWithPolicy);
  add("own_policy_8_worlds", PolicyRate(*model, kWorldsOfBatch), "1150 required",
      kRequiredWithPolicy);
  const auto add_scaling = [&](const std::string& name, const Scaling& scaling) {
    add(name + "_two_threads", scaling.two.wall, "one thread, 1.9 required", scaling.one.wall, 2);
    add(name + "_two_threads_computing", scaling.two.computing, "one thread, 1.9 required",
        scaling.one.computing, 2);
  };
  add_scaling("own", ScalingOfWorlds(*model));
  add_scaling("own_policy_8_worlds", ScalingOfPolicy(*model));
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
