#include <string>
#include <vector>

#include "bench/benchmark.h"
#include "bench/measure_rate.h"
#include "core/motion/joint_roles.h"
#include "core/push/push_forecaster.h"
#include "core/push/standing_person.h"

/// How long one thread takes for a frame of a push forecast.
namespace poise::bench {
namespace {

constexpr int kFrames = 60;

push::ScenePerson PersonAt(double x, double y) {
  const motion::Clip& clip = push::StandingPerson();
  push::ScenePerson person =
      *push::PersonOf(clip, 0, *motion::JointRoles::Detect(*clip.skeleton()));
  person.mass_kg = 75;
  person.hip += push::Vec3(x, y, 0);
  person.pendulum.position.head<2>() += Eigen::Vector2d(x, y);
  return person;
}

push::PushScene BlockScene(int people, int columns) {
  constexpr double kSpacing = 0.45;  // [m]
  push::PushScene scene;
  for (int i = 0; i < people; ++i) {
    scene.people.push_back(PersonAt(kSpacing * (i / columns), kSpacing * (i % columns)));
  }
  scene.pushes.push_back(
      {.person = columns / 2, .first_frame = 0, .frames = 12, .force_n = Eigen::Vector2d(325, 0)});
  scene.frames = kFrames;
  return scene;
}

double MillisecondsPerFrame(const push::PushForecaster& forecaster, int people, int columns) {
  const push::PushScene scene = BlockScene(people, columns);
  const double rate = MeasureRate([&] {
    const auto rollout = forecaster.Start(scene);
    for (int frame = 0; frame < kFrames; ++frame) {
      if (!rollout->Next().ok()) std::abort();
    }
  });
  return 1000 / (rate * kFrames);
}

}  // namespace

std::vector<Row> RunPushBenchmark() {
  const auto statue = *push::MakeStatueForecaster({});
  const double thirteen = MillisecondsPerFrame(*statue, 13, 3);
  const double hundred = MillisecondsPerFrame(*statue, 100, 10);
  const double thousand = MillisecondsPerFrame(*statue, 1000, 25);
  const double growth = (thousand / 1000) / (hundred / 100);
  return {{"push/statue/13_people", thirteen, "ms/frame", "2 ms required", 2 / thirteen, 1},
          {"push/statue/13_people_vs_paper", thirteen, "ms/frame", "paper: 190 ms on a GPU",
           190 / thirteen, 1},
          {"push/statue/100_people", hundred, "ms/frame", "16 ms required", 16 / hundred, 1},
          {"push/statue/1000_people", thousand, "ms/frame", "", 0, 1},
          {"push/statue/per_person_1000_vs_100", growth, "x", "1.3 x required", 1.3 / growth, 1}};
}

}  // namespace poise::bench
