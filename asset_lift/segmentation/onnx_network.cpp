#include <algorithm>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "asset_lift/segmentation/network_formats.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::asset_lift {
namespace {

// Keeps OpenCV from printing its own report of a fault that becomes a core::Error.
class QuietOpenCv {
 public:
  QuietOpenCv() : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
  }
  ~QuietOpenCv() {
    cv::redirectError(nullptr);
    cv::utils::logging::setLogLevel(level_);
  }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel level_;
};

// Returns OpenCV's reason without its file and line, on one line.
std::string ReasonOf(const cv::Exception& error) {
  constexpr size_t kLongest = 200;
  std::string reason = error.err.substr(0, kLongest);
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  return reason;
}

std::string ShapeOf(const cv::Mat& blob) {
  std::string text;
  for (int i = 0; i < blob.dims; ++i) {
    text += (i == 0 ? "" : " x ") + std::to_string(blob.size[i]);
  }
  return text;
}

class OnnxNetwork final : public SalientNetwork {
 public:
  OnnxNetwork(cv::dnn::Net net, const std::filesystem::path& file, int side,
              InputNormalisation normalisation)
      : SalientNetwork(file, side, normalisation), net_(std::move(net)) {}

 protected:
  SaliencyMap Run(const std::vector<float>& input) override {
    const std::array<int, 4> sizes = {1, 3, side(), side()};
    const cv::Mat blob(4, sizes.data(), CV_32F, const_cast<float*>(input.data()));
    cv::Mat output;
    try {
      const QuietOpenCv quiet;
      net_.setInput(blob);
      // The first of several outputs is the final one: U2-Net's others are of coarser stages.
      const std::vector<std::string> names = net_.getUnconnectedOutLayersNames();
      if (names.empty())
        throw core::Error("the network has no output", where(), kExpectedSignature);
      output = net_.forward(names.front());
    } catch (const cv::Exception& error) {
      throw core::Error("the network does not run on an input of 1 x 3 x " +
                            std::to_string(side()) + " x " + std::to_string(side()) + ": " +
                            ReasonOf(error),
                        where(), kExpectedSignature);
    }
    if (output.dims != 4 || output.size[0] != 1 || output.size[1] != 1 || output.type() != CV_32F ||
        output.total() == 0) {
      throw core::Error("the network's first output is " + ShapeOf(output), where(),
                        kExpectedSignature);
    }
    const float* values = output.ptr<float>();
    return {output.size[3], output.size[2], {values, values + output.total()}};
  }

 private:
  cv::dnn::Net net_;
};

}  // namespace

std::shared_ptr<SalientNetwork> LoadOnnxNetwork(const std::filesystem::path& file,
                                                const SalientNetworkOptions& options) {
  const std::string bytes = core::ReadFile(file, 1ull << 31);
  const std::optional<OnnxInput> input = ReadOnnxInput(bytes);
  if (!input) {
    throw core::Error("is not an ONNX model", file.string(),
                      "export it with torch.onnx.export, or give a TorchScript module (.pt)");
  }
  if (input->rank != 4 || (input->channels != 0 && input->channels != 3) ||
      input->height != input->width) {
    throw core::Error("the network's input has another shape: " + std::to_string(input->rank) +
                          " dimensions, " + std::to_string(input->channels) + " channels of " +
                          std::to_string(input->width) + " x " + std::to_string(input->height),
                      file.string(), kExpectedSignature);
  }
  if (!input->fp32) {
    throw core::Error("the network's input is not fp32, which OpenCV 4.6 needs", file.string(),
                      "export it in fp32");
  }
  if (options.side != 0 && input->height != 0 && options.side != input->height) {
    throw core::Error(
        "the network's input is fixed to " + std::to_string(input->height) + " pixels per side",
        file.string(), "omit --segmenter-size");
  }
  constexpr int kUsualSide = 320;  // of U2-Net
  const int side =
      input->height != 0 ? input->height : (options.side != 0 ? options.side : kUsualSide);
  try {
    const QuietOpenCv quiet;
    return std::make_shared<OnnxNetwork>(cv::dnn::readNetFromONNX(bytes.data(), bytes.size()), file,
                                         side, options.normalisation);
  } catch (const cv::Exception& error) {
    throw core::Error("OpenCV cannot read the network: " + ReasonOf(error), file.string(),
                      "export it in fp32 with opset 11 to 13, or as a TorchScript module (.pt)");
  }
}

}  // namespace simwright::asset_lift
