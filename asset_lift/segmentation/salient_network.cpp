#include "asset_lift/segmentation/salient_network.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "asset_lift/segmentation/network_formats.h"
#include "core/error.h"

namespace simwright::asset_lift {
namespace {

constexpr int kSmallestSide = 16, kLargestSide = 4096;

std::string LowerCaseText(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

InputNormalisation NormalisationFor(const std::string& name, InputNormalisation stated) {
  if (stated != InputNormalisation::kByName) return stated;
  return LowerCaseText(name).find("isnet") != std::string::npos ? InputNormalisation::kHalf
                                                                : InputNormalisation::kImageNet;
}

// Returns the photo as (3 x side x side), normalised.
std::vector<float> PlanesOf(const core::Image& photo, int side, InputNormalisation normalisation) {
  std::array<float, 3> mean = {0.0f, 0.0f, 0.0f}, deviation = {1.0f, 1.0f, 1.0f};
  if (normalisation == InputNormalisation::kImageNet) {
    mean = {0.485f, 0.456f, 0.406f};
    deviation = {0.229f, 0.224f, 0.225f};
  } else if (normalisation == InputNormalisation::kHalf) {
    mean = {0.5f, 0.5f, 0.5f};
  }
  const core::Image small = core::Resize(photo, side, side);
  const size_t plane = static_cast<size_t>(side) * static_cast<size_t>(side);
  std::vector<float> planes(3 * plane);
  for (size_t c = 0; c < 3; ++c) {
    const size_t channel = small.channels < 3 ? 0 : c;
    for (size_t i = 0; i < plane; ++i) {
      const float value =
          static_cast<float>(small.pixels[i * static_cast<size_t>(small.channels) + channel]) /
          255.0f;
      planes[c * plane + i] = (value - mean[c]) / deviation[c];
    }
  }
  return planes;
}

// Turns logits into probabilities; probabilities stay as they are, but for rounding errors.
void MakeProbabilities(std::vector<float>* values) {
  constexpr float kRounding = 1e-3f;
  const auto [low, high] = std::minmax_element(values->begin(), values->end());
  const bool logits = *low < -kRounding || *high > 1.0f + kRounding;
  for (float& value : *values) {
    value = logits ? 1.0f / (1.0f + std::exp(-value)) : std::clamp(value, 0.0f, 1.0f);
  }
}

}  // namespace

SaliencyMap SalientNetwork::Predict(const core::Image& photo) {
  SaliencyMap map = Run(PlanesOf(photo, side_, NormalisationFor(name(), normalisation_)));
  const bool finite = std::all_of(map.values.begin(), map.values.end(),
                                  [](float value) { return std::isfinite(value); });
  if (!finite) throw core::Error("the network returns values that are not finite", where());
  MakeProbabilities(&map.values);
  return map;
}

std::shared_ptr<SalientNetwork> LoadSalientNetwork(const std::filesystem::path& file,
                                                   const SalientNetworkOptions& options) {
  if (options.side != 0 && (options.side < kSmallestSide || options.side > kLargestSide)) {
    throw core::Error("the network's input must be 16 to 4096 pixels per side, not " +
                          std::to_string(options.side),
                      file.string(), "correct --segmenter-size");
  }
  const std::string extension = LowerCaseText(file.extension().string());
  std::shared_ptr<SalientNetwork> network;
  if (extension == ".onnx") {
    network = LoadOnnxNetwork(file, options);
  } else if (extension == ".pt" || extension == ".pth" || extension == ".torchscript") {
    network = LoadScriptedNetwork(file, options);
  } else {
    throw core::Error("is neither an ONNX file nor a TorchScript module by its ending",
                      file.string(), "name it .onnx or .pt");
  }
  network->Predict(core::Image(64, 64, 3, 128));
  return network;
}

}  // namespace simwright::asset_lift
