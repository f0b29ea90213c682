#include <gmock/gmock.h>

#include <map>

#include "core/push/body_joints.h"
#include "core/push/pendulum/pendulum.h"
#include "core/push/restoration/pose_features.h"
#include "core/push/takes/csv_table.h"
#include "core/push/takes/fzj_takes.h"
#include "tests/core/push/fzj_data.h"

namespace poise::push {
namespace {

Eigen::Matrix<double, 1, 6> PendulumFeatures(const TakePerson& person, int frame) {
  const auto position = [&](int at) {
    return PaperPendulumOf(person.joint(at, kPelvis), person.joint(at, kRightAnkle),
                           person.joint(at, kLeftAnkle))
        .position;
  };
  const Eigen::Vector4d now = position(frame), change = position(frame + 1) - now;
  Eigen::Matrix<double, 1, 6> features;
  features << now[2], now[3], change.transpose();
  return features;
}

struct Sets {
  std::map<std::string, std::vector<Eigen::RowVectorXd>> rows;

  void Add(const TakePerson& person) {
    const BodyMotion motion{person.frames(), person.joints, person.rotations};
    const Eigen::MatrixXd low = PoseFeatures(motion, kLowerBody);
    const Eigen::MatrixXd up = PoseFeatures(motion, kUpperBody);
    for (int frame = 0; frame < low.rows(); ++frame) {
      rows["train_low"].push_back(low.row(frame));
      if (frame + 1 == low.rows()) continue;
      Eigen::RowVectorXd condition(198), low_guide(117), up_guide(204);
      condition << up.row(frame), low.block<1, 27>(frame + 1, 3);
      const auto pendulum = PendulumFeatures(person, frame + 1);
      low_guide << pendulum, low.row(frame);
      up_guide << pendulum, condition;
      rows["train_up"].push_back(condition);
      rows["train_low_guide"].push_back(low_guide);
      rows["train_up_guide"].push_back(up_guide);
    }
  }
};

TEST(PoseFeaturesDataTest, StatisticsOfTheSingleTrainingSetAreTheReleasedOnes) {
  POISE_REQUIRE_DATA("fzj_push");
  Sets sets;
  for (const PushTake* take : TakesOf(testing::SingleTakes(), Split::kTrain)) {
    sets.Add(take->people[0]);
  }
  const auto csv =
      CsvTable::Read(poise::testing::DataPath("fzj_push/checks/single_feature_stats.csv"),
                     {"set", "rows", "column", "mean", "std_unbiased"});
  ASSERT_TRUE(csv.ok()) << csv.status();
  EXPECT_EQ(csv->num_rows(), 630);
  for (int line = 0; line < csv->num_rows(); ++line) {
    const auto& rows = sets.rows.at(std::string(csv->text(line, 0)));
    ASSERT_EQ(static_cast<int>(rows.size()), csv->integer(line, 1));
    const int column = csv->integer(line, 2);
    double mean = 0, variance = 0;
    for (const auto& row : rows) mean += row[column];
    mean /= rows.size();
    for (const auto& row : rows) variance += std::pow(row[column] - mean, 2);
    const double deviation = std::sqrt(variance / (rows.size() - 1));
    // A mean near zero is a difference of large numbers: relative to the column's spread.
    ASSERT_NEAR(mean, csv->number(line, 3), 1e-9 * (std::abs(mean) + deviation)) << line;
    ASSERT_NEAR(deviation, csv->number(line, 4), 1e-9 * deviation) << line;
  }
}

}  // namespace
}  // namespace poise::push
