#include "core/runtime/serving/batching_predictor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "absl/synchronization/notification.h"
#include "absl/time/clock.h"
#include "core/artifacts/model_artifact.h"
#include "core/base/random.h"
#include "core/math/rotation.h"
#include "core/prediction/predictor_registry.h"
#include "tests/support/test_clips.h"

namespace poise::serving {
namespace {

using motion::Clip;
using prediction::Observation;

// Holds still; the first pass waits until it is let go, and passes fail that see an actor "bad".
class Gated : public prediction::Predictor {
 public:
  const prediction::PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                      const base::RunContext& context) const override {
    POISE_RETURN_IF_ERROR(context.Check());
    if (passes_++ == 0) {
      begun_.Notify();
      go_.WaitForNotification();
    }
    largest_ = std::max<size_t>(largest_, batch.size());
    for (const Observation& seen : batch) {
      if (seen.past.name() == "bad") return base::Internal("NOT_FINITE", "bad");
      if (seen.past.name() == "throws") throw std::runtime_error("thrown");
    }
    return prediction::FindBuiltInPredictor("zero-velocity")->Predict(batch, future_frames, {});
  }
  mutable std::atomic<int> passes_ = 0;
  mutable std::atomic<size_t> largest_ = 0;
  mutable absl::Notification begun_, go_;

 private:
  prediction::PredictorSignature signature_{.max_future_frames = 50};
};

Clip Named(const std::string& name, uint64_t seed = 1) {
  Clip clip = testing::SwingingClip(20, 60, 0.3, seed);
  clip.set_name(name);
  return clip;
}

/// One executor that is busy with a first request until it is let go.
class BatchingPredictorTest : public ::testing::Test {
 protected:
  void Make(const ServingConfig& config) {
    batching_ = std::make_unique<BatchingPredictor>(gated_, config, base::Telemetry::None(),
                                                    base::Labels{});
    Ask("first");
    gated_->begun_.WaitForNotification();
  }
  // A request from a thread of its own; its status in statuses_[i] after Join.
  void Ask(const std::string& name, int future = 5, base::RunContext context = {}) {
    const size_t i = threads_.size();
    threads_.emplace_back([this, i, name, future, context] {
      const Observation seen{Named(name, i), {}};
      const auto futures = batching_->Predict({&seen, 1}, future, context);
      statuses_[i] = futures.status();
      if (!futures.ok()) return;
      EXPECT_EQ(futures->size(), 1u);
      EXPECT_EQ(futures->front().num_frames(), future);
      EXPECT_LT((futures->front().root_position(0) - seen.past.root_position(19)).norm(), 1e-9)
          << "an answer of its own";
    });
  }
  void Join() {
    for (std::thread& thread : threads_) thread.join();
  }

  std::shared_ptr<Gated> gated_ = std::make_shared<Gated>();
  std::unique_ptr<BatchingPredictor> batching_;
  std::vector<std::thread> threads_;
  Status statuses_[64];
};

constexpr absl::Duration kLong = absl::Seconds(30);

TEST_F(BatchingPredictorTest, RequestsThatWaitAreAnsweredInOnePass) {
  Make({.max_batch = 8, .executors = 1, .max_added_delay = kLong});
  for (int i = 0; i < 6; ++i) Ask("clip", 1 + i);
  absl::SleepFor(absl::Milliseconds(100));  // until all wait
  gated_->go_.Notify();
  Join();
  for (size_t i = 0; i < threads_.size(); ++i) EXPECT_TRUE(statuses_[i].ok()) << statuses_[i];
  EXPECT_LE(gated_->passes_, 4) << "one for the first, and fewer for six than six";
  EXPECT_GE(gated_->largest_, 3u);
}

TEST_F(BatchingPredictorTest, NoPassIsLargerThanItMayBe) {
  Make({.max_batch = 3, .executors = 1, .max_added_delay = kLong});
  for (int i = 0; i < 10; ++i) Ask("clip");
  absl::SleepFor(absl::Milliseconds(50));
  gated_->go_.Notify();
  Join();
  EXPECT_LE(gated_->largest_, 3u);
  EXPECT_GE(gated_->passes_, 5);
}

TEST_F(BatchingPredictorTest, NobodyWaitsLongerThanTheCeilingForOthers) {
  Make({.max_batch = 8, .executors = 1, .max_added_delay = absl::Milliseconds(20)});
  Ask("clip");
  threads_[1].join();  // while the first is not done
  EXPECT_TRUE(statuses_[1].ok()) << statuses_[1];
  gated_->go_.Notify();
  threads_[0].join();
}

TEST_F(BatchingPredictorTest, DeadlineAndCancellationHoldInTheQueue) {
  Make({.max_batch = 8, .executors = 1, .max_added_delay = kLong});
  base::RunContext late, cancelled;
  late.deadline = absl::Now() + absl::Milliseconds(30);
  Ask("late", 5, late);
  Ask("cancelled", 5, cancelled);
  threads_[1].join();  // while the first is not done
  EXPECT_TRUE(absl::IsDeadlineExceeded(statuses_[1])) << statuses_[1];
  cancelled.cancellation.Cancel();
  gated_->go_.Notify();
  threads_[0].join();
  threads_[2].join();
  EXPECT_TRUE(absl::IsCancelled(statuses_[2])) << statuses_[2];
  EXPECT_EQ(gated_->passes_, 1) << "neither was computed";
}

TEST_F(BatchingPredictorTest, ARequestThatFailsFailsAlone) {
  Make({.max_batch = 8, .executors = 1, .max_added_delay = kLong});
  for (const char* name : {"clip", "bad", "clip"}) Ask(name);
  absl::SleepFor(absl::Milliseconds(50));
  gated_->go_.Notify();
  Join();
  EXPECT_TRUE(statuses_[1].ok()) << statuses_[1];
  EXPECT_EQ(base::ErrorReason(statuses_[2]), "NOT_FINITE");
  EXPECT_TRUE(statuses_[3].ok()) << statuses_[3];
}

TEST_F(BatchingPredictorTest, AnExceptionLeavesNobodyWaiting) {
  Make({.max_batch = 8, .executors = 1, .max_added_delay = kLong});
  Ask("throws");
  Ask("clip");
  absl::SleepFor(absl::Milliseconds(50));
  gated_->go_.Notify();
  Join();
  EXPECT_EQ(base::ErrorReason(statuses_[1]), "UNEXPECTED_EXCEPTION");
  Ask("later");
  threads_.back().join();
  EXPECT_TRUE(statuses_[3].ok()) << statuses_[3];
}

TEST(BatchingPredictorErrorTest, WhatCannotBeAnsweredIsRefusedBeforeItJoinsABatch) {
  const BatchingPredictor batching(std::make_shared<Gated>(), {}, base::Telemetry::None(), {});
  const Observation seen{Named("clip"), {}};
  EXPECT_EQ(base::ErrorReason(batching.Predict({&seen, 1}, 51, {}).status()), "HORIZON_TOO_LONG");
  EXPECT_EQ(base::ErrorReason(batching.Predict({&seen, 1}, 0, {}).status()), "BAD_HORIZON");
}

// The shipped network, asked from many threads for futures of any length: as asked alone, to 1e-5.
TEST(BatchingPredictorModelTest, AnswersDoNotDependOnTheCompany) {
  const auto model = artifacts::ReadModelFolder(POISE_SOURCE_DIR "/models/predictor-cmu/1");
  ASSERT_TRUE(model.ok()) << model.status();
  const auto predictor = prediction::MakeTrainedPredictor(*model);
  ASSERT_TRUE(predictor.ok()) << predictor.status();
  const auto& signature = (*predictor)->signature();
  const BatchingPredictor batching(*predictor, {.executors = 1}, base::Telemetry::None(), {});
  constexpr int kThreads = 12, kEach = 6;
  std::atomic<int> compared = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&, thread] {
      base::Random random(thread);
      for (int i = 0; i < kEach; ++i) {
        std::vector<motion::Vec3> positions(signature.past_frames, motion::Vec3(0.1 * i, 1, 0));
        std::vector<motion::Quat> rotations;
        for (int k = 0; k < signature.past_frames * signature.skeleton->num_joints(); ++k) {
          rotations.push_back(math::FromRotationVector(
              {random.Uniform(-0.5, 0.5), random.Uniform(-0.5, 0.5), random.Uniform(-0.5, 0.5)}));
        }
        const Observation seen{*Clip::Create("clip", signature.skeleton, signature.frame_rate,
                                             std::move(positions), std::move(rotations)),
                               {}};
        const int future = 1 + static_cast<int>(random.Index(signature.max_future_frames));
        const auto together = batching.Predict({&seen, 1}, future, {});
        const auto alone = (*predictor)->Predict({&seen, 1}, future, {});
        ASSERT_TRUE(together.ok() && alone.ok()) << together.status();
        ASSERT_EQ(together->front().num_frames(), future);
        for (int frame = 0; frame < future; ++frame) {
          EXPECT_LT((together->front().root_position(frame) - alone->front().root_position(frame))
                        .cwiseAbs()
                        .maxCoeff(),
                    1e-5);
          for (int joint = 0; joint < signature.skeleton->num_joints(); ++joint) {
            EXPECT_LT((together->front().rotation(frame, joint).coeffs() -
                       alone->front().rotation(frame, joint).coeffs())
                          .cwiseAbs()
                          .maxCoeff(),
                      1e-5);
          }
        }
        ++compared;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(compared, kThreads * kEach);
}

}  // namespace
}  // namespace poise::serving
