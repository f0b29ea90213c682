#ifndef POISE_CORE_PREDICTION_POTR_POTR_NET_H_
#define POISE_CORE_PREDICTION_POTR_POTR_NET_H_

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "core/prediction/potr/potr_config.h"
#include "core/prediction/tensors/column_tensors.h"
#include "core/prediction/tensors/graph_convolution.h"

namespace poise::prediction {

/// Attention of several heads between frames, with dropout on its weights.
/// Shapes: query (batch, queries, width); key, value (batch, frames, width)
class Attention : public torch::nn::Module {
 public:
  Attention(int64_t width, int64_t heads, double dropout);
  torch::Tensor forward(const torch::Tensor& query, const torch::Tensor& key,
                        const torch::Tensor& value);

 private:
  const int64_t heads_;
  const double dropout_;
  torch::nn::Linear in_ = nullptr, out_ = nullptr;  // of query, key and value; of what they say
};

/// PotrPredictor's network, to be trained. All future frames at once: each asks with the last
/// observed frame. The authors' program asks in training with that one too, but in its tests with
/// the first frame to be predicted, which gives that away. Source: reference sec. 4.3 and 6.4.
class PotrNet : public ColumnNet {
 public:
  PotrNet(const PotrConfig& config, const NetworkBody& body, const EulerMeasure& measure);

  /// Mean absolute error, of every layer of the decoder.
  torch::Tensor Loss(const PoseTensors& windows) override;
  torch::Tensor Forward(const torch::Tensor& past) override { return ByLayer(past).back(); }

 private:
  struct EncoderLayer {
    std::shared_ptr<Attention> attention;
    torch::nn::LayerNorm norm1 = nullptr, norm2 = nullptr;
    torch::nn::Linear up = nullptr, down = nullptr;
  };
  struct DecoderLayer {
    std::shared_ptr<Attention> self, cross;
    torch::nn::LayerNorm norm1 = nullptr, norm2 = nullptr, norm3 = nullptr;
    torch::nn::Linear up = nullptr, down = nullptr;
  };
  void BuildEmbedding();
  void BuildLayers();
  torch::Tensor Embed(const torch::Tensor& rows);  // (batch, frames, width)
  torch::Tensor Encode(torch::Tensor x);
  torch::Tensor Decode(DecoderLayer& layer, const torch::Tensor& x, const torch::Tensor& memory);
  std::vector<torch::Tensor> ByLayer(const torch::Tensor& past);  // (batch, future, columns) each
  torch::Tensor Positions(int frames) const;
  torch::Tensor Drop(const torch::Tensor& x) const;

  const PotrConfig config_;
  std::vector<std::shared_ptr<GraphConvolution>> graphs_;
  torch::nn::Linear frame_ = nullptr, pose_ = nullptr;
  std::vector<EncoderLayer> encoder_;
  std::vector<DecoderLayer> decoder_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_POTR_POTR_NET_H_
