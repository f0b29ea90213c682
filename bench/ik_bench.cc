#include <array>
#include <memory>
#include <string>

#include "bench/bench_clip.h"
#include "bench/benchmark.h"
#include "core/motion/kinematics/fabrik.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/pipeline/augment.h"

/// How many variants of a clip of 3 s at 120 Hz and 31 joints one thread makes in a second, through
/// the flow that the server runs.
namespace poise::bench {
namespace {

using motion::Clip;
using motion::JointRole;
using motion::JointRoles;
using motion::Quat;
using motion::Vec3;

constexpr int kFrames = 361;
constexpr double kFrameRate = 120;
constexpr double kRequiredRate = 200;  // variants per second and core

double FlowRate(const std::string& method, bool with_plausibility) {
  const Clip clip = CapturedSizeClip(kFrames, kFrameRate);
  api::AugmentSpec spec;
  spec.sources.push_back({clip, {}});
  spec.method = method;
  spec.variants_per_source = api::AugmentSpec::kMaxVariants;
  spec.with_plausibility = with_plausibility;
  const auto flow =
      *pipeline::AugmentFlow::Create(spec, {{clip, *JointRoles::Detect(*clip.skeleton())}});
  int64_t ordinal = 0;
  return MeasureRate([&] {
    const auto variant = flow->Make(ordinal++ % flow->num_variants(), {});
    if (!variant.ok()) std::abort();
  });
}

// One variant as it is written first: per frame the whole body's forward kinematics, FABRIK's
// iteration, and the rotations from world poses; nothing kept from one variant to the next.
Clip NaiveVariant(const Clip& source, const JointRoles& roles, const Vec3& displacement) {
  const int hip = roles.joint(JointRole::kLeftHip), knee = roles.joint(JointRole::kLeftKnee),
            ankle = roles.joint(JointRole::kLeftAnkle);
  const auto& skeleton = *source.skeleton();
  Clip variant = source;
  for (int frame = 0; frame < source.num_frames(); ++frame) {
    motion::WorldPoses poses;
    motion::ForwardKinematics(source, frame, 1, poses);
    const auto parent = [&](int joint) { return poses.rotation(0, skeleton.parent(joint)); };
    const std::array old = {poses.position(0, hip), poses.position(0, knee),
                            poses.position(0, ankle)};
    std::array joints = old;
    const double weight = 1 - std::abs(2.0 * frame / (source.num_frames() - 1) - 1);
    motion::SolveFabrik(joints, std::array{(old[1] - old[0]).norm(), (old[2] - old[1]).norm()},
                        old[2] + weight * displacement);
    const Quat upper = math::SwingBetween(old[1] - old[0], joints[1] - joints[0]);
    const Quat lower = math::SwingBetween(old[2] - old[1], joints[2] - joints[1]);
    variant.rotation(frame, hip) = parent(hip).conjugate() * upper * poses.rotation(0, hip);
    variant.rotation(frame, knee) =
        (upper * parent(knee)).conjugate() * lower * poses.rotation(0, knee);
    variant.rotation(frame, ankle) = (lower * parent(ankle)).conjugate() * poses.rotation(0, ankle);
  }
  return variant;
}

double NaiveRate() {
  const Clip clip = CapturedSizeClip(kFrames, kFrameRate);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  int64_t sink = 0;
  const double rate =
      MeasureRate([&] { sink += NaiveVariant(clip, roles, Vec3(0.05, 0.05, 0.1)).num_frames(); });
  if (sink == 0) std::abort();
  return rate;
}

}  // namespace

std::vector<Row> RunIkBenchmark() {
  const double variants = FlowRate("ik", false);
  const double naive = NaiveRate();
  const std::string required = "200 variants/s required";
  std::vector<Row> rows = {
      {"ik/variants", variants, "variants/s", required, variants / kRequiredRate, 1},
      {"ik/variants_vs_naive", variants, "variants/s", "whole-body FK and FABRIK per frame",
       variants / naive, 1}};
  const auto add = [&](const std::string& name, double value) {
    rows.push_back({name, value, "variants/s", required, value / kRequiredRate, 1});
  };
  add("ik/with_plausibility", FlowRate("ik", true));
  add("ik+timewarp/variants", FlowRate("ik+timewarp", false));
  add("ik+timewarp/with_plausibility", FlowRate("ik+timewarp", true));
  add("noise/variants", FlowRate("noise", false));
  return rows;
}

}  // namespace poise::bench
