#include "core/push/learned/pose_model.h"

namespace poise::push {

StatusOr<PoseModel> PoseModel::Read(const base::TensorFile& file, const std::string& prefix,
                                    const PoseConfig& config) {
  PoseModel model;
  model.config_ = config;
  POISE_ASSIGN_OR_RETURN(model.cell_, GruLayer::Read(file, prefix + "cell.", "_l0",
                                                     kPathSize + kBodySize, config.hidden));
  POISE_ASSIGN_OR_RETURN(model.pose_,
                         LinearLayer::Read(file, prefix + "pose", config.hidden, kPoseSize));
  return model;
}

MatrixXf PoseModel::Step(const MatrixXf& path, const MatrixXf& body, MatrixXf& memory) const {
  MatrixXf input(path.rows(), kPathSize + kBodySize);
  input << path, body;
  cell_.Step(input, memory);
  MatrixXf pose = pose_(memory);
  auto swings = pose.middleCols<2>(kSwingColumn).array();
  const Eigen::ArrayXXf probability = 1 / (1 + (-swings).exp());
  pose *= static_cast<float>(kPoseScale);
  pose.middleCols<2>(kSwingColumn) = probability.matrix();
  return pose;
}

}  // namespace poise::push
