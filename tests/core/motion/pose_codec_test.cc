#include "core/motion/pose_codec.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

std::vector<RotationCodec> AllCodecs() {
  using enum RotationRepresentation;
  std::vector<RotationCodec> codecs = {{kQuaternion}, {kMatrix}, {kSixD}, {kExponentialMap}};
  for (const char* order : {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "ZXZ", "XYX"}) {
    codecs.push_back({kEuler, *math::ParseEulerOrder(order)});
  }
  return codecs;
}

// Every joint spins about its own axis, several full turns over the clip.
Clip SpinningClip(int frames, double turns) {
  const SkeletonPtr skeleton = testing::Biped();
  base::Random random(5);
  std::vector<Vec3> axes, positions;
  for (int j = 0; j < skeleton->num_joints(); ++j) {
    axes.push_back(Vec3(random.Normal(), random.Normal(), random.Normal()).normalized());
  }
  std::vector<Quat> rotations;
  for (int frame = 0; frame < frames; ++frame) {
    positions.push_back(Vec3(random.Normal(), random.Normal(), random.Normal()));
    for (const Vec3& axis : axes) {
      const double angle = turns * 2 * M_PI * frame / (frames - 1);
      rotations.push_back(Quat(Eigen::AngleAxisd(angle, axis)));
    }
  }
  return *Clip::Create("spin", skeleton, 60, positions, rotations);
}

TEST(PoseCodecTest, EveryRepresentationRoundTrips) {
  for (const Clip& clip : {testing::SwingingClip(20, 30, 3.0, 7), SpinningClip(200, 4)}) {
    for (const RotationCodec& codec : AllCodecs()) {
      for (const bool with_root : {true, false}) {
        const PoseMatrix poses = EncodePoses(clip, codec, with_root);
        ASSERT_EQ(poses.cols(), (with_root ? 3 : 0) + clip.num_joints() * codec.width());
        const Clip back = *DecodePoses(poses, codec, "back", clip.skeleton(), 60, with_root);
        for (int frame = 0; frame < clip.num_frames(); ++frame) {
          EXPECT_EQ(back.root_position(frame),
                    with_root ? clip.root_position(frame) : Vec3(0, 0, 0));
          for (int joint = 0; joint < clip.num_joints(); ++joint) {
            EXPECT_LT(
                math::GeodesicDistance(back.rotation(frame, joint), clip.rotation(frame, joint)),
                1e-7);
          }
        }
      }
    }
  }
}

TEST(PoseCodecTest, ColumnsHoldWhatTheHeaderSays) {
  const SkeletonPtr skeleton = *Skeleton::Create({{"root", -1, Vec3::Zero(), {}}});
  const Quat turn = math::FromEuler(Vec3(0.3, -0.2, 0.9), math::kZXY);
  const math::Mat3 m = turn.toRotationMatrix();
  const Clip clip = *Clip::Create("one", skeleton, 30, {Vec3(1, 2, 3)}, {turn});
  using enum RotationRepresentation;
  Eigen::VectorXd expected(12);
  expected << 1, 2, 3, m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1),
      m(2, 2);
  EXPECT_LT((EncodePoses(clip, {kMatrix}).row(0).transpose() - expected).norm(), 1e-12);
  expected.resize(6);
  expected << m.col(0), m.col(1);
  EXPECT_LT((EncodePoses(clip, {kSixD}, false).row(0).transpose() - expected).norm(), 1e-12);
  expected.resize(4);
  expected << turn.w(), turn.x(), turn.y(), turn.z();
  EXPECT_LT((EncodePoses(clip, {kQuaternion}, false).row(0).transpose() - expected).norm(), 1e-12);
  expected.resize(3);
  expected << 0.3, -0.2, 0.9;
  EXPECT_LT((EncodePoses(clip, {kEuler, math::kZXY}, false).row(0).transpose() - expected).norm(),
            1e-12);
}

TEST(PoseCodecTest, ExponentialMapGrowsSteadilyOverFourTurns) {
  const Clip clip = SpinningClip(200, 4);
  const PoseMatrix poses =
      EncodePoses(clip, {RotationRepresentation::kExponentialMap}, /*with_root_position=*/false);
  const double step = 4 * 2 * M_PI / 199;
  for (int frame = 1; frame < 200; ++frame) {
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      const Vec3 now = poses.row(frame).segment<3>(3 * joint);
      const Vec3 before = poses.row(frame - 1).segment<3>(3 * joint);
      EXPECT_NEAR((now - before).norm(), step, 1e-6) << frame << " " << joint;
    }
  }
}

TEST(PoseCodecTest, QuaternionsDoNotFlipTheirSignAlongTime) {
  const Clip clip = SpinningClip(200, 4);
  const PoseMatrix poses = EncodePoses(clip, {RotationRepresentation::kQuaternion}, false);
  EXPECT_LT((poses.bottomRows(199) - poses.topRows(199)).cwiseAbs().maxCoeff(), 0.1);
}

TEST(PoseCodecTest, WrongWidthAndNonRotationsAreNamedByFrameAndJoint) {
  const Clip clip = testing::SwingingClip(4);
  const auto decode = [&](const PoseMatrix& poses, RotationRepresentation representation) {
    return DecodePoses(poses, {representation}, "bad", clip.skeleton(), 30).status();
  };
  using enum RotationRepresentation;
  PoseMatrix poses = EncodePoses(clip, {kQuaternion});
  EXPECT_EQ(base::ErrorReason(decode(poses.leftCols(60), kQuaternion)), "WRONG_SHAPE");
  EXPECT_EQ(base::ErrorReason(decode(poses, kMatrix)), "WRONG_SHAPE");

  const int knee = *clip.skeleton()->Find("left_knee");
  const auto expect_named = [&](const Status& status, const char* reason) {
    EXPECT_EQ(base::ErrorReason(status), reason);
    EXPECT_NE(base::Message(status).find("frame 2"), std::string::npos) << status;
    EXPECT_NE(base::Message(status).find("left_knee"), std::string::npos) << status;
  };
  poses.row(2).segment<4>(3 + 4 * knee) *= 1.5;
  expect_named(decode(poses, kQuaternion), "NOT_A_ROTATION");
  poses = EncodePoses(clip, {kMatrix});
  poses(2, 3 + 9 * knee + 4) += 0.1;
  expect_named(decode(poses, kMatrix), "NOT_A_ROTATION");
  poses = EncodePoses(clip, {kSixD});
  poses.row(2).segment<6>(3 + 6 * knee).setZero();
  expect_named(decode(poses, kSixD), "DEGENERATE_ROTATION");
  poses = EncodePoses(clip, {kExponentialMap});
  poses(2, 3 + 3 * knee) = std::nan("");
  expect_named(decode(poses, kExponentialMap), "NOT_FINITE");
  EXPECT_EQ(base::ErrorReason(decode(PoseMatrix(0, 3 + 3 * clip.num_joints()), kExponentialMap)),
            "NO_FRAMES");
}

}  // namespace
}  // namespace poise::motion
