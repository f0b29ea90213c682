#ifndef POISE_CORE_SYNTHESIS_VAE_LATENT_MAP_H_
#define POISE_CORE_SYNTHESIS_VAE_LATENT_MAP_H_

#include <Eigen/Core>
#include <string>
#include <vector>

namespace poise::synthesis {

/// Where training motions and samples lie in the latent space, as a picture: the two principal axes
/// of the training motions, whose clusters are filled circles of one colour each; samples are small
/// and hollow. Source: MotionAug's figure 12.
/// Shapes: training, samples (motions, latent), at least one training motion and two dimensions;
/// clusters: indices into training. Returns SVG.
std::string LatentMap(const Eigen::MatrixXd& training,
                      const std::vector<std::vector<int>>& clusters,
                      const Eigen::MatrixXd& samples);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_LATENT_MAP_H_
