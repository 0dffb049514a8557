#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"

namespace simwright::asset_lift {

// The values that a network expects in place of a photo's sRGB values in [0, 1]: (value - mean) /
// deviation per channel.
enum class InputNormalisation {
  kByName,    // kHalf if the file's name contains "isnet", else kImageNet
  kImageNet,  // mean 0.485, 0.456, 0.406, deviation 0.229, 0.224, 0.225: U2-Net, BASNet, BiRefNet
  kHalf,      // mean 0.5, deviation 1: IS-Net
  kNone       // unchanged
};

struct SalientNetworkOptions {
  // Pixels per side of the network's square input, 16 to 4096. 0: the size that the ONNX file or
  // the module's attribute `side` states, otherwise 320.
  int side = 0;
  InputNormalisation normalisation = InputNormalisation::kByName;
};

// The probability in [0, 1] that a pixel shows the salient object, rows from the top.
struct SaliencyMap {
  int width = 0, height = 0;
  std::vector<float> values;  // (height x width)
};

// A network for salient object detection. Use it from one thread at a time.
class SalientNetwork {
 public:
  SalientNetwork(std::filesystem::path file, int side, InputNormalisation normalisation)
      : file_(std::move(file)), side_(side), normalisation_(normalisation) {}
  virtual ~SalientNetwork() = default;

  // Returns the map of the whole `photo`, which is stretched to the network's square input. Outputs
  // outside [0, 1] are taken for logits. Throws core::Error if the network fails or returns values
  // that are not finite.
  SaliencyMap Predict(const core::Image& photo);
  std::string name() const { return file_.filename().string(); }
  int side() const { return side_; }  // pixels

 protected:
  // Runs the network on (1 x 3 x side x side) and returns its first output, (1 x 1 x h x w).
  virtual SaliencyMap Run(const std::vector<float>& input) = 0;
  std::string where() const { return file_.string(); }  // for messages

 private:
  std::filesystem::path file_;
  int side_;
  InputNormalisation normalisation_;
};

// Loads a network from an ONNX file in fp32 (.onnx, run by OpenCV) or from a TorchScript module
// (.pt, .pth, .torchscript). The input is (1 x 3 x S x S), the first output (1 x 1 x h x w). A
// trial run shows a wrong signature at once. Throws core::Error, with the expected and the actual
// signature, if the file is missing, of another format, uses a layer that the runtime lacks, or has
// another signature.
std::shared_ptr<SalientNetwork> LoadSalientNetwork(const std::filesystem::path& file,
                                                   const SalientNetworkOptions& options = {});

}  // namespace simwright::asset_lift
