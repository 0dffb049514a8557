#include "twin/detector_network.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "core/error.h"

namespace simwright::twin {
namespace {

constexpr int kPixelNumbers = 4;  // object, centre, two of the offset

nn::UNetOptions UNetOf(const DetectorNetworkOptions& options) {
  nn::UNetOptions unet;
  unet.in_channels = 3;
  unet.out_channels = kPixelNumbers;
  unet.channels = options.channels;
  unet.patch = options.patch;
  unet.attention_from = static_cast<int>(options.channels.size()) - 1;
  return unet;
}

}  // namespace

bool DetectorNetworkOptions::IsValid(std::string* error) const {
  const bool counts =
      channels.size() == 4 && std::all_of(channels.begin(), channels.end(), [](int count) {
        return count >= 8 && count <= 1024 && count % 8 == 0;
      });
  if (counts && patch >= 1 && patch <= 8) return true;
  if (error) {
    *error = counts ? "the network's patch must have 1 to 8 pixels a side"
                    : "the network needs four channel counts, multiples of 8 up to 1024";
  }
  return false;
}

nn::CheckpointMetadata MetadataOf(const DetectorNetworkOptions& options) {
  std::string list;
  for (const int count : options.channels)
    list += (list.empty() ? "" : ",") + std::to_string(count);
  return {{"channels", list}, {"patch", std::to_string(options.patch)}};
}

DetectorNetworkOptions ReadDetectorSizes(const std::filesystem::path& weights) {
  const nn::CheckpointMetadata metadata = nn::ReadCheckpointMetadata(weights, "table detector");
  const auto text = [&](const char* name) {
    const auto found = metadata.find(name);
    return found == metadata.end() ? std::string() : found->second;
  };
  DetectorNetworkOptions options;
  options.channels.clear();
  std::istringstream counts(text("channels"));
  for (std::string count; std::getline(counts, count, ',');) {
    options.channels.push_back(std::atoi(count.c_str()));
  }
  options.patch = std::atoi(text("patch").c_str());
  if (!options.IsValid(nullptr)) {
    throw core::Error("the weights name no valid sizes of the network", weights.string(),
                      "train them again: simwright prior train --only detector");
  }
  return options;
}

DetectorNetworkImpl::DetectorNetworkImpl(const DetectorNetworkOptions& options) {
  unet_ = register_module("unet", nn::UNet(UNetOf(options)));
}

DetectorOutput DetectorNetworkImpl::Detect(const torch::Tensor& pictures) {
  const torch::Tensor pixels = unet_(pictures);
  return {pixels.slice(1, 0, 1), pixels.slice(1, 1, 2), pixels.slice(1, 2, 4)};
}

torch::Tensor DetectorPictures(const std::uint8_t* rgb, int count, int height, int width) {
  return torch::from_blob(const_cast<std::uint8_t*>(rgb), {count, height, width, 3}, torch::kUInt8)
      .permute({0, 3, 1, 2})
      .to(torch::kFloat)
      .div(127.5)
      .sub(1.0)
      .contiguous();
}

}  // namespace simwright::twin
