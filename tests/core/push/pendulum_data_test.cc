// The pendulum against the released states, accelerations and forces (reference sec. 15).
#include <gmock/gmock.h>

#include "core/push/pendulum/pendulum.h"
#include "core/push/takes/csv_table.h"
#include "tests/core/push/fzj_data.h"

namespace poise::push {
namespace {

using poise::testing::DataPath;
using testing::TakeNamed;

const std::vector<std::string> kStateColumns = {"x_m",     "y_m",   "theta_rad",
                                                "phi_rad", "rod_m", "cart_z_m"};

PendulumPose PoseOf(const TakePerson& person, int frame) {
  return PaperPendulumOf(person.joint(frame, kPelvis), person.joint(frame, kRightAnkle),
                         person.joint(frame, kLeftAnkle));
}

double Difference(const PendulumPose& found, const CsvTable& csv, int row, int first) {
  double worst = 0;
  for (int i = 0; i < 4; ++i) {
    worst = std::max(worst, std::abs(found.position[i] - csv.number(row, first + i)));
  }
  worst = std::max(worst, std::abs(found.rod - csv.number(row, first + 4)));
  return std::max(worst, std::abs(found.cart_height - csv.number(row, first + 5)));
}

CsvTable ReadOrDie(const std::string& file, std::vector<std::string> columns) {
  auto csv = CsvTable::Read(DataPath("fzj_push/" + file), columns);
  EXPECT_TRUE(csv.ok()) << csv.status();
  return *std::move(csv);
}

std::vector<std::string> Join(std::vector<std::string> first,
                              const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST(PendulumDataTest, StatesOfOnePersonAreTheReleasedOnes) {
  POISE_REQUIRE_DATA("fzj_push");
  const CsvTable csv =
      ReadOrDie("ipm_states/single.csv", Join({"subject", "index", "frame"}, kStateColumns));
  EXPECT_EQ(csv.num_rows(), 3104);
  for (int row = 0; row < csv.num_rows(); ++row) {
    const PushTake& take = TakeNamed(std::string(csv.text(row, 0)), csv.integer(row, 1));
    const double off = Difference(PoseOf(take.people[0], csv.integer(row, 2)), csv, row, 3);
    ASSERT_LT(off, 1e-9) << take.name() << " row " << row;
  }
}

TEST(PendulumDataTest, StatesOfSeveralPeopleAreTheReleasedOnes) {
  POISE_REQUIRE_DATA("fzj_push");
  const CsvTable csv =
      ReadOrDie("ipm_states/multi.csv", Join({"group", "take", "person", "frame"}, kStateColumns));
  EXPECT_EQ(csv.num_rows(), 25705);
  for (int row = 0; row < csv.num_rows(); ++row) {
    const PushTake& take = TakeNamed(std::string(csv.text(row, 0)), csv.integer(row, 1));
    const TakePerson& person = take.people[csv.integer(row, 2)];
    const double off = Difference(PoseOf(person, csv.integer(row, 3)), csv, row, 4);
    ASSERT_LT(off, 1e-9) << person.file << " row " << row;
  }
}

TEST(PendulumDataTest, AccelerationsAreTheReleasedOnes) {
  POISE_REQUIRE_DATA("fzj_push");
  const CsvTable csv =
      ReadOrDie("checks/dynamics_sample.csv",
                {"mass_total", "rod", "theta", "phi", "thetadot", "phidot", "Fx", "Fy", "Ftheta",
                 "Fphi", "xddot", "yddot", "thetaddot", "phiddot"});
  const int rows = csv.num_rows();
  EXPECT_EQ(rows, 20);
  PendulumStates states{PendulumArray::Zero(rows, 4), PendulumArray::Zero(rows, 4),
                        PersonArray(rows)};
  PersonArray mass(rows);
  PendulumArray force(rows, 4), expected(rows, 4);
  for (int row = 0; row < rows; ++row) {
    mass[row] = csv.number(row, 0);
    states.rod[row] = csv.number(row, 1);
    for (int i = 0; i < 2; ++i) {
      states.position(row, 2 + i) = csv.number(row, 2 + i);
      states.velocity(row, 2 + i) = csv.number(row, 4 + i);
    }
    for (int i = 0; i < 4; ++i) {
      force(row, i) = csv.number(row, 6 + i);
      expected(row, i) = csv.number(row, 10 + i);
    }
  }
  const PendulumArray found = Accelerations(states, mass, force);
  EXPECT_LT(((found - expected) / expected).abs().maxCoeff(), 1e-8);
}

// The released force of row `frame`: the inverse dynamics of the recorded motion with the next
// frame's rod, and 100 N s/m of friction.
Eigen::Vector4d RecordedForce(const TakePerson& person, int frame) {
  constexpr double kFriction = 100;
  const PendulumPose now = PoseOf(person, frame), next = PoseOf(person, frame + 1);
  Eigen::Vector4d before_rate = Eigen::Vector4d::Zero();
  if (frame > 0) before_rate = (now.position - PoseOf(person, frame - 1).position) * kFrameRate;
  const Eigen::Vector4d rate = (next.position - now.position) * kFrameRate;
  const PendulumStates states{now.position.transpose().array(), before_rate.transpose().array(),
                              PersonArray::Constant(1, next.rod)};
  const PersonArray mass = PersonArray::Constant(1, person.mass_kg);
  Eigen::Vector4d force =
      InverseDynamics(states, mass, (rate - before_rate).transpose().array() * kFrameRate)
          .row(0)
          .matrix()
          .transpose();
  force.head<2>() += kFriction * before_rate.head<2>();
  return force;
}

TEST(PendulumDataTest, ReleasedPushesAreTheInverseDynamicsOfTheRecordedMotion) {
  POISE_REQUIRE_DATA("fzj_push");
  double worst = 0, sum = 0;
  int rows = 0;
  for (const PushTake& take : testing::MultiTakes()) {
    for (size_t frame = 0; frame < take.force.size(); ++frame) {
      const double off =
          (RecordedForce(take.people[0], static_cast<int>(frame)) - take.force[frame])
              .cwiseAbs()
              .maxCoeff();
      worst = std::max(worst, off);
      sum += off;
      ++rows;
    }
  }
  EXPECT_EQ(rows, 5551);
  EXPECT_LT(worst, 0.071);  // 0.07 as stated is rounded
  EXPECT_LT(sum / rows, 0.01);
}

}  // namespace
}  // namespace poise::push
