#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "asset_lift/segmentation/salient_network.h"

namespace simwright::asset_lift {

// The signature that a network must have, for messages.
inline constexpr const char* kExpectedSignature =
    "expected one input 1 x 3 x S x S in fp32 and a first output 1 x 1 x S x S, as U2-Net and "
    "IS-Net have; give S with --segmenter-size";

// Returns a network that OpenCV runs, and one that libtorch runs. Both throw core::Error if the
// file cannot be read; the first run shows whether the signature is right.
std::shared_ptr<SalientNetwork> LoadOnnxNetwork(const std::filesystem::path& file,
                                                const SalientNetworkOptions& options);
std::shared_ptr<SalientNetwork> LoadScriptedNetwork(const std::filesystem::path& file,
                                                    const SalientNetworkOptions& options);

// The first input of an ONNX model that is no weight.
struct OnnxInput {
  int height = 0, width = 0;  // pixels; 0: not fixed in the file
  int channels = 0;           // 0: not fixed in the file
  int rank = 0;               // number of dimensions
  bool fp32 = true;
};

// Reads the first input from the bytes of an ONNX file. Returns nothing if they are not an ONNX
// model with an input. Never throws and never reads beyond `bytes`.
std::optional<OnnxInput> ReadOnnxInput(std::string_view bytes);

}  // namespace simwright::asset_lift
