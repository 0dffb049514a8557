#include "library_fit/library_network.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>

#include "core/error.h"

namespace simwright::library_fit {
namespace {

constexpr int kEmbedding = 96;
constexpr int kHidden = 384;
constexpr int kNumbers = 10;

}  // namespace

nn::CheckpointMetadata LibraryNetworkOptions::Metadata() const {
  std::string list;
  for (const int count : channels) list += (list.empty() ? "" : ",") + std::to_string(count);
  return {{"channels", list}, {"features", std::to_string(features)}};
}

LibraryNetworkOptions LibraryNetworkOptions::Of(const std::filesystem::path& weights) {
  const nn::CheckpointMetadata metadata = nn::ReadCheckpointMetadata(weights, "library");
  const auto list = metadata.find("channels"), features = metadata.find("features");
  const auto valid = [](int count) { return count >= 8 && count <= 4096 && count % 8 == 0; };
  LibraryNetworkOptions options;
  options.channels.clear();
  if (list != metadata.end() && features != metadata.end()) {
    std::istringstream counts(list->second);
    for (std::string count; std::getline(counts, count, ',');) {
      options.channels.push_back(std::atoi(count.c_str()));
    }
    options.features = std::atoi(features->second.c_str());
  }
  if (options.channels.size() != 4 || !valid(options.features) ||
      !std::all_of(options.channels.begin(), options.channels.end(), valid)) {
    throw core::Error("the weights name no valid sizes of the network", weights.string(),
                      "train them again: simwright prior train --only library");
  }
  return options;
}

LibraryNetworkImpl::LibraryNetworkImpl(int kinds, const LibraryNetworkOptions& options) {
  namespace tn = torch::nn;
  int before = options.channels.front();
  stem_ = register_module("stem", tn::Conv2d(tn::Conv2dOptions(4, before, 5).stride(2).padding(2)));
  blocks_ = register_module("blocks", tn::ModuleList());
  for (const int channels : options.channels) {
    blocks_->push_back(nn::ResidualBlock(before, channels, 0));
    before = channels;
  }
  norm_ = register_module("norm", tn::GroupNorm(tn::GroupNormOptions(8, before)));
  feature_ = register_module("feature", tn::Linear(before * 16, options.features));
  kind_ = register_module("kind", tn::Linear(options.features, kinds));
  embedding_ = register_module("embedding", tn::Embedding(kinds, kEmbedding));
  hidden_ = register_module("hidden", tn::Linear(options.features + kEmbedding, 2 * kHidden));
  const int outputs = kAzimuthBins + (kPriorDraws + 1) * kChoiceBins + kNumbers;
  parameters_ = register_module("parameters", tn::Linear(kHidden + kEmbedding, outputs));
}

torch::Tensor LibraryNetworkImpl::Features(const torch::Tensor& pictures) {
  torch::Tensor x = stem_(pictures);
  for (size_t i = 0; i < blocks_->size(); ++i) {
    if (i > 0) x = torch::avg_pool2d(x, 2);
    x = blocks_[i]->as<nn::ResidualBlockImpl>()->forward(x, {});
  }
  // 4 x 4 positions: where parts are matters.
  return torch::silu(feature_(torch::silu(norm_(x)).flatten(1)));
}

torch::Tensor LibraryNetworkImpl::KindLogits(const torch::Tensor& features) {
  return kind_(features);
}

LibraryNetworkOutput LibraryNetworkImpl::Parameters(const torch::Tensor& features,
                                                    const torch::Tensor& kinds) {
  const torch::Tensor of = embedding_(kinds);
  const std::vector<torch::Tensor> gate = hidden_(torch::cat({features, of}, 1)).chunk(2, 1);
  const torch::Tensor h = gate[0] * torch::sigmoid(gate[1]);
  const torch::Tensor all = parameters_(torch::cat({h, of}, 1));
  LibraryNetworkOutput output;
  const int choices = (kPriorDraws + 1) * kChoiceBins;
  output.azimuth = all.slice(1, 0, kAzimuthBins);
  output.choices = all.slice(1, kAzimuthBins, kAzimuthBins + choices)
                       .reshape({-1, kPriorDraws + 1, kChoiceBins});
  output.numbers = all.slice(1, kAzimuthBins + choices, kAzimuthBins + choices + kNumbers);
  return output;
}

torch::Tensor LibraryPictures(const std::uint8_t* rgba, int count) {
  const torch::Tensor bytes = torch::from_blob(const_cast<std::uint8_t*>(rgba),
                                               {count, kPriorSide, kPriorSide, 4}, torch::kUInt8)
                                  .permute({0, 3, 1, 2})
                                  .to(torch::kFloat)
                                  .div(255.0);
  const torch::Tensor alpha = bytes.slice(1, 3, 4);
  return torch::cat({(2.0 * bytes.slice(1, 0, 3) - 1.0) * alpha, alpha}, 1).contiguous();
}

}  // namespace simwright::library_fit
