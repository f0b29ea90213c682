#include "core/push/evaluation/forecast_take.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/random.h"
#include "core/push/learned/body_ensemble.h"
#include "core/push/restoration/rigid_fit.h"
#include "core/push/takes/recorded_hip.h"

namespace poise::push {
namespace {

constexpr std::array kColumns = {"mpjpe",
                                 "hipade",
                                 "hipfde",
                                 "mble",
                                 "pose_only",
                                 "fse_toe_033",
                                 "true_fse_toe_033",
                                 "fse_toe_050",
                                 "true_fse_toe_050",
                                 "fse_ankle_150",
                                 "true_fse_ankle_150",
                                 "toe_contact",
                                 "true_toe_contact",
                                 "steps",
                                 "true_steps",
                                 "step_recall"};

BodyShape ShapeIn(const TakePerson& person, int frame) {
  BodyShape shape;
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    shape[joint] = person.joint(frame, joint) - person.joint(frame, kPelvis);
  }
  return shape;
}

// Recorded hips as the hip networks would hand them on; `ahead` frames beyond the end.
std::vector<HipMoment> RecordedMoments(const PushTake& take, int ahead) {
  const int people = static_cast<int>(take.people.size());
  std::vector<HipMoment> moments(take.frames + ahead);
  for (HipMoment& moment : moments) {
    moment.path = moment.rate = moment.lean = moment.lean_change = FloorVectors::Zero(people, 2);
    moment.headings = FacingX(people);
    moment.takes_part.assign(people, true);
  }
  for (int i = 0; i < people; ++i) {
    const TakePerson& person = take.people[i];
    const auto lean = [&](int frame) {
      const PendulumPose pose =
          PendulumOf(person.joint(frame, kPelvis), person.joint(frame, kRightAnkle),
                     person.joint(frame, kLeftAnkle));
      return Eigen::RowVector2f(pose.position.tail<2>().cast<float>().transpose());
    };
    const auto path = RecordedHip(person, take.frames + ahead);
    moments[0].beginners.push_back(i);
    for (int frame = 0; frame < take.frames + ahead; ++frame) {
      HipMoment& moment = moments[frame];
      moment.frame = frame;
      moment.path.row(i) = path[frame].cast<float>().transpose();
      moment.lean.row(i) = lean(std::min(frame, take.frames - 1));
      moment.lean_change.row(i) = moment.lean.row(i) - moments[0].lean.row(i);
      if (frame == 0) continue;
      moment.rate.row(i) = ((path[frame] - path[frame - 1]) * kFrameRate).cast<float>().transpose();
    }
  }
  return moments;
}

std::string Row(const ScoreLabels& labels, const std::string& take, const Measures& measures) {
  std::string row =
      fmt::format("{},{},{},{},{}", labels.model, labels.protocol, labels.set, labels.seed, take);
  for (const char* column : kColumns) row += fmt::format(",{:.6g}", measures.at(column));
  return row + "\n";
}

}  // namespace

PushScene SceneOf(const PushTake& take, Protocol protocol, base::Random& random) {
  PushScene scene;
  for (const TakePerson& person : take.people) {
    scene.people.push_back(
        {.id = person.suit,
         .mass_kg = person.mass_kg,
         .pendulum = PendulumOf(person.joint(0, kPelvis), person.joint(0, kRightAnkle),
                                person.joint(0, kLeftAnkle)),
         .hip = person.joint(0, kPelvis),
         .shape = ShapeIn(person, 0)});
  }
  const PushInput input = InputOf(take, protocol, random);
  ScenePush push{.frames = take.push_frames};
  push.force_n = {input.impulse_ns * kFrameRate / take.push_frames, 0};
  if (protocol != Protocol::kB) push.recorded_n = input.force_n;
  scene.pushes.push_back(std::move(push));
  scene.frames = take.frames;
  return scene;
}

StatusOr<ForecastJoints> ForecastTake(const PushForecaster& forecaster, const PushTake& take,
                                      Protocol protocol, const base::RunContext& context) {
  base::Random random(context.seed);
  const PushScene scene = SceneOf(take, protocol, random);
  const auto rollout = forecaster.Start(scene);
  ForecastJoints forecast(take.people.size());
  for (int frame = 0; frame < take.frames; ++frame) {
    POISE_RETURN_IF_ERROR(context.Check());
    POISE_ASSIGN_OR_RETURN(const PushFrame* now, rollout->Next());
    for (size_t i = 0; i < forecast.size(); ++i) {
      BodyShape body = scene.people[i].shape;
      if (!now->turns.empty()) body = Turned(body, now->turns[i]);
      const Vec3 hip = now->hips.row(i).matrix().transpose();
      for (const Vec3& joint : body) forecast[i].push_back(hip + joint);
    }
  }
  return forecast;
}

ForecastJoints ForecastOnTrueHip(const PushNetworks& networks, const PushTake& take) {
  base::Random random(0);
  const PushScene scene = SceneOf(take, Protocol::kB, random);
  BodyEnsemble bodies(scene, networks);
  const int lookahead = networks.lookahead();
  const std::vector<HipMoment> moments = RecordedMoments(take, lookahead);
  ForecastJoints forecast(take.people.size());
  for (int frame = 0; frame < take.frames; ++frame) {
    const HipMoment& now = moments[frame];
    bodies.Step(now, moments[frame + lookahead / 2], moments[frame + lookahead]);
    for (size_t i = 0; i < forecast.size(); ++i) {
      const Vec3 hip =
          scene.people[i].hip + Vec3(now.path(i, 0), now.path(i, 1), bodies.heights()[i]);
      for (const Vec3& joint : Turned(scene.people[i].shape, bodies.turns()[i])) {
        forecast[i].push_back(hip + joint);
      }
    }
  }
  return forecast;
}

StatusOr<std::vector<TakeScores>> EvaluateForecaster(const PushForecaster& forecaster,
                                                     std::span<const PushTake* const> takes,
                                                     Protocol protocol,
                                                     const base::RunContext& context) {
  std::vector<TakeScores> scores;
  for (const PushTake* take : takes) {
    POISE_ASSIGN_OR_RETURN(const ForecastJoints forecast,
                           ForecastTake(forecaster, *take, protocol, context));
    scores.push_back(ScoreTake(*take, forecast));
    context.Report({.step = static_cast<int64_t>(scores.size()),
                    .total = static_cast<int64_t>(takes.size()),
                    .message = take->name()});
  }
  return scores;
}

std::string PushScoresHeader() {
  std::string header = "model,protocol,set,seed,take";
  for (const char* column : kColumns) header += fmt::format(",{}", column);
  return header + "\n";
}

std::string PushScoresRows(const ScoreLabels& labels, std::span<const TakeScores> scores) {
  std::string rows;
  for (const TakeScores& take : scores) rows += Row(labels, take.take, take.measures);
  rows += Row(labels, "mean", MeanOverTakes(scores));
  const std::vector<TakeScores> kept = WithoutOutliers(scores);
  if (!kept.empty()) rows += Row(labels, "mean_without_outliers", MeanOverTakes(kept));
  return rows;
}

PairedDifference Compare(std::span<const TakeScores> ours, std::span<const TakeScores> theirs,
                         const std::string& measure, uint64_t seed) {
  constexpr int kDraws = 10'000;
  std::vector<double> differences;
  PairedDifference result;
  for (size_t i = 0; i < ours.size(); ++i) {
    const double difference = ours[i].measures.at(measure) - theirs[i].measures.at(measure);
    differences.push_back(difference);
    result.mean += difference / ours.size();
    result.better_share += (difference < 0 ? 1.0 : 0.0) / ours.size();
  }
  base::Random random(seed);
  std::vector<double> means(kDraws, 0);
  for (double& mean : means) {
    for (size_t i = 0; i < differences.size(); ++i) {
      mean += differences[random.Index(differences.size())] / differences.size();
    }
  }
  std::sort(means.begin(), means.end());
  result.low = means[kDraws / 20];
  result.high = means[kDraws - kDraws / 20 - 1];
  return result;
}

}  // namespace poise::push
