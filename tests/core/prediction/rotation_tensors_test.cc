// Rotations in tensors against the ones that everything else is checked against.
#include "core/prediction/tensors/rotation_tensors.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/math/rotation.h"
#include "core/motion/metrics/euler_error.h"

namespace poise::prediction {
namespace {

using math::Quat;
using math::Vec3;

torch::Tensor Tensor(const Quat& q) { return torch::tensor({q.w(), q.x(), q.y(), q.z()}); }
torch::Tensor Tensor(const Vec3& v) { return torch::tensor({v.x(), v.y(), v.z()}); }

template <typename Vector>
double Distance(const torch::Tensor& tensor, const Vector& expected) {
  double largest = 0;
  for (int i = 0; i < expected.size(); ++i) {
    largest = std::max(largest, std::abs(tensor[i].item<double>() - expected[i]));
  }
  return largest;
}

class RotationTensorsTest : public ::testing::Test {
 protected:
  RotationTensorsTest() {
    torch::set_default_dtype(caffe2::TypeMeta::Make<double>());
    for (int i = 0; i < 50; ++i) {
      vectors_.emplace_back(random_.Normal(), random_.Normal(), random_.Normal());
    }
  }
  ~RotationTensorsTest() override { torch::set_default_dtype(caffe2::TypeMeta::Make<float>()); }
  base::Random random_{3};
  std::vector<Vec3> vectors_;
};

TEST_F(RotationTensorsTest, AgreeWithTheScalarOnes) {
  for (size_t i = 0; i + 1 < vectors_.size(); ++i) {
    const Quat a = math::FromRotationVector(vectors_[i]);
    const Quat b = math::FromRotationVector(vectors_[i + 1]);
    const Quat product = a * b;
    EXPECT_LT(Distance(Multiply(Tensor(a), Tensor(b)),
                       Eigen::Vector4d(product.w(), product.x(), product.y(), product.z())),
              1e-6);
    EXPECT_LT(Distance(Rotate(Tensor(a), Tensor(vectors_[i + 1])), Vec3(a * vectors_[i + 1])),
              1e-6);
    EXPECT_LT(Distance(LogMap(Tensor(a)), math::ToRotationVector(a)), 1e-6);
    EXPECT_LT(Distance(LogMap(Tensor(Quat(-a.coeffs()))), math::ToRotationVector(a)), 1e-6);
    EXPECT_LT(Distance(SixD(Tensor(a)), math::ToSixD(a)), 1e-6);
    const Vec3 vector = math::ToRotationVector(a);
    EXPECT_LT(Distance(PaperEuler(Tensor(a), false), motion::EulerOfRotationVector(vector)), 5e-6);
    EXPECT_LT(Distance(PaperEuler(Tensor(a), true), motion::EulerOfRotationVector(-vector)), 5e-6);
  }
}

TEST_F(RotationTensorsTest, ExpUndoesLogAndIsExactAtNoRotation) {
  for (const Vec3& vector : vectors_) {
    const Quat a = math::FromRotationVector(vector);
    const torch::Tensor back = ExpMap(LogMap(Tensor(a)));
    EXPECT_NEAR(std::abs((back * Tensor(a)).sum().item<double>()), 1, 1e-9);
  }
  EXPECT_LT(Distance(ExpMap(torch::zeros({3})), Eigen::Vector4d(1, 0, 0, 0)), 1e-6);
}

TEST_F(RotationTensorsTest, SlopesAreThoseOfFiniteDifferences) {
  const double step = 1e-5;
  for (int i = 0; i < 10; ++i) {
    torch::Tensor vector = Tensor(Vec3(0.5 * vectors_[i])).set_requires_grad(true);
    const auto value = [](const torch::Tensor& v) {
      return (PaperEuler(ExpMap(v), true) * torch::tensor({1.0, -2.0, 3.0})).sum() +
             LogMap(ExpMap(v)).square().sum();
    };
    value(vector).backward();
    for (int axis = 0; axis < 3; ++axis) {
      torch::Tensor shift = torch::zeros({3});
      shift[axis] = step;
      const torch::NoGradGuard no_gradient;
      const double slope =
          (value(vector + shift) - value(vector - shift)).item<double>() / (2 * step);
      EXPECT_NEAR(vector.grad()[axis].item<double>(), slope, 1e-5 * (1 + std::abs(slope)));
    }
  }
}

}  // namespace
}  // namespace poise::prediction
