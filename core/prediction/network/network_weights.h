#ifndef POISE_CORE_PREDICTION_NETWORK_NETWORK_WEIGHTS_H_
#define POISE_CORE_PREDICTION_NETWORK_NETWORK_WEIGHTS_H_

#include <list>
#include <string>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/network/layers.h"

namespace poise::prediction {

/// A trained network's numbers, read by the names that LibTorch gave them and kept for as long as
/// the forward pass points into them.
/// Errors of all that read: those of base::TensorFile::Floats.
class NetworkWeights {
 public:
  NetworkWeights() = default;
  NetworkWeights(const NetworkWeights&) = delete;  // others point into it
  NetworkWeights& operator=(const NetworkWeights&) = delete;

  StatusOr<const float*> Take(const base::TensorFile& file, const std::string& name,
                              std::vector<int64_t> shape);
  /// `name`.weight and, where `biased`, `name`.bias.
  StatusOr<LayerWeights> TakeLinear(const base::TensorFile& file, const std::string& name,
                                    int64_t outputs, int64_t inputs, bool biased = true);
  StatusOr<LayerWeights> TakeNorm(const base::TensorFile& file, const std::string& name,
                                  int64_t features);
  /// GraphConvolution's, with its batch norm as a scale and a shift per number.
  struct GraphShape {
    int nodes, inputs, outputs;
    bool biased, normed;
  };
  StatusOr<GraphLayer> TakeGraph(const base::TensorFile& file, const std::string& name,
                                 const GraphShape& shape);

 private:
  const float* Keep(std::vector<float> numbers);

  std::list<std::vector<float>> numbers_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_NETWORK_NETWORK_WEIGHTS_H_
