// Networks for salient object detection, from ONNX and TorchScript, in segmentation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "asset_lift/segmentation/network_formats.h"
#include "asset_lift/segmentation/salient_network.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/error.h"
#include "core/files.h"
#include "nn/torch_script.h"
#include "tests/asset_lift/onnx_writer.h"

namespace simwright::asset_lift {
namespace {
namespace fs = std::filesystem;

constexpr int kSide = 64;
constexpr double kGain = 20.0, kBias = -4.0;  // logit = kGain (red - green) + kBias

double Logit(double red, double green) {
  return kGain * (red - green) + kBias;
}

double Probability(double logit) {
  return 1.0 / (1.0 + std::exp(-logit));
}

// The same on ImageNet's normalised channels.
std::vector<float> Weights() {
  return {static_cast<float>(kGain * 0.229), static_cast<float>(-kGain * 0.224), 0.0f};
}
std::vector<float> Bias() {
  return {static_cast<float>(kGain * (0.485 - 0.456) + kBias)};
}

fs::path SaveOnnx(const core::TemporaryFolder& folder, const std::string& name,
                  const std::string& bytes) {
  core::WriteFile(folder.path() / name, bytes);
  return folder.path() / name;
}

fs::path SaveScript(const core::TemporaryFolder& folder, const std::string& name,
                    const std::string& methods) {
  torch::jit::Module module("network");
  module.register_attribute("side", c10::IntType::get(), kSide);
  module.define(methods);
  module.save((folder.path() / name).string());
  return folder.path() / name;
}

// U2-Net's form: a tuple whose first member is the finest map.
fs::path RedScript(const core::TemporaryFolder& folder) {
  return SaveScript(folder, "red.pt", R"(
def forward(self, image):
    red = image[:, 0:1] * 0.229 + 0.485
    green = image[:, 1:2] * 0.224 + 0.456
    finest = torch.sigmoid(20.0 * (red - green) - 4.0)
    return (finest, 1.0 - finest)
)");
}

// A red disc with a bar of two pixels on its right, and a blue disc of the same size.
bool InRed(int x, int y) {
  const bool disc = std::hypot(x - 120.0, y - 150.0) < 60.0;
  return disc || (x >= 120 && x < 230 && y >= 150 && y < 152);
}
core::Image RedAndBlue() {
  core::Image photo(400, 300, 3);
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      const auto grain = static_cast<std::uint8_t>((x * 7 + y * 13) % 5);
      std::uint8_t* pixel = photo.At(x, y);
      std::fill_n(pixel, 3, static_cast<std::uint8_t>(200 + grain));
      if (InRed(x, y)) {
        pixel[0] = 190;
        pixel[1] = static_cast<std::uint8_t>(50 + grain);
        pixel[2] = 40;
      } else if (std::hypot(x - 310.0, y - 150.0) < 60.0) {
        pixel[0] = 40;
        pixel[1] = 50;
        pixel[2] = static_cast<std::uint8_t>(190 + grain);
      }
    }
  }
  return photo;
}

TEST(SalientNetwork, BothFormatsGiveTheFormulaOfTheirNetwork) {
  const core::TemporaryFolder folder;
  core::Image photo(kSide, kSide, 3);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      photo.At(x, y)[0] = static_cast<std::uint8_t>(4 * x);
      photo.At(x, y)[1] = static_cast<std::uint8_t>(2 * y);
      photo.At(x, y)[2] = 77;
    }
  }
  for (const fs::path& file :
       {RedScript(folder),
        SaveOnnx(folder, "red.onnx", OnnxConvolution(Weights(), Bias(), kSide))}) {
    const auto network = LoadSalientNetwork(file);
    EXPECT_EQ(network->side(), kSide) << file;
    EXPECT_EQ(network->name(), file.filename().string());
    const SaliencyMap map = network->Predict(photo);
    ASSERT_EQ(map.values.size(), static_cast<size_t>(kSide * kSide)) << file;
    for (int y = 0; y < kSide; y += 7) {
      for (int x = 0; x < kSide; x += 5) {
        EXPECT_NEAR(map.values[static_cast<size_t>(y * kSide + x)],
                    Probability(Logit(4 * x / 255.0, 2 * y / 255.0)), 1e-4)
            << file << " at " << x << ", " << y;
      }
    }
  }
}

TEST(SalientNetwork, TheNormalisationFollowsTheNameOrTheOption) {
  const core::TemporaryFolder folder;
  const std::string bytes = OnnxConvolution({1.0f, 0.0f, 0.0f}, {0.0f}, 0);
  const core::Image photo(kSide, kSide, 3, 102);  // 0.4
  const auto at = [&](const std::string& name, InputNormalisation normalisation) {
    const auto network = LoadSalientNetwork(SaveOnnx(folder, name, bytes), {32, normalisation});
    EXPECT_EQ(network->side(), 32);
    return network->Predict(photo).values.at(100);
  };
  using enum InputNormalisation;
  EXPECT_NEAR(at("u2netp.onnx", kByName), Probability((0.4 - 0.485) / 0.229), 1e-5);
  EXPECT_NEAR(at("ISNet-general.onnx", kByName), Probability(0.4 - 0.5), 1e-5);
  EXPECT_NEAR(at("isnet.onnx", kImageNet), Probability((0.4 - 0.485) / 0.229), 1e-5);
  EXPECT_NEAR(at("any.onnx", kNone), Probability(0.4), 1e-5);
}

TEST(SalientNetwork, LogitsBecomeProbabilities) {
  const core::TemporaryFolder folder;
  const auto network = LoadSalientNetwork(SaveScript(folder, "logits.pt", R"(
def forward(self, image):
    return torch.full([1, 1, 20, 30], 2.5)
)"));
  const SaliencyMap map = network->Predict(core::Image(40, 40, 1, 9));
  EXPECT_EQ(map.width, 30);
  EXPECT_EQ(map.height, 20);
  EXPECT_NEAR(map.values.front(), Probability(2.5), 1e-6);
}

TEST(SalientNetwork, FindsItsObjectAndTheThinPartThatItOnlyGuesses) {
  const core::TemporaryFolder folder;
  const core::Image photo = RedAndBlue();
  EXPECT_THROW(SegmentObject(photo, {}), core::Error);  // two objects
  SegmentationOptions options;
  options.network = LoadSalientNetwork(RedScript(folder));
  const Matte matte = SegmentObject(photo, {}, options);
  EXPECT_EQ(matte.method, "the network red.pt");
  const SaliencyMap map = options.network->Predict(photo);
  int both = 0, either = 0, coarse_both = 0, coarse_either = 0, bar = 0, found = 0;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      const bool truth = InRed(x, y), inside = matte.alpha.At(x, y)[0] > 127;
      const int column = x * map.width / photo.width, row = y * map.height / photo.height;
      const bool coarse = map.values[static_cast<size_t>(row * map.width + column)] > 0.5f;
      both += truth && inside;
      either += truth || inside;
      coarse_both += truth && coarse;
      coarse_either += truth || coarse;
      const bool in_bar = truth && x >= 184;
      bar += in_bar;
      found += in_bar && inside;
    }
  }
  const double iou = static_cast<double>(both) / either;
  const double coarse_iou = static_cast<double>(coarse_both) / coarse_either;
  EXPECT_GT(iou, 0.98);
  EXPECT_LT(coarse_iou, 0.96);  // the network alone
  EXPECT_GT(found, 0.9 * bar);
  RecordProperty("iou", std::to_string(iou) + " network alone " + std::to_string(coarse_iou));
}

TEST(SalientNetwork, ItsAbsenceOfAnObjectIsReported) {
  const core::TemporaryFolder folder;
  SegmentationOptions options;
  options.network = LoadSalientNetwork(RedScript(folder));
  try {
    SegmentObject(core::Image(200, 200, 3, 90), {}, options);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("red.pt sees no object"), std::string::npos)
        << error.what();
  }
}

// Returns the message for a file that is no usable network.
std::string RefusalOf(const fs::path& file, const SalientNetworkOptions& options = {}) {
  try {
    LoadSalientNetwork(file, options);
  } catch (const core::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with(file.string())) << message;
    return message;
  }
  return "";
}

TEST(SalientNetwork, WrongFilesAreRefusedInOneLine) {
  const core::TemporaryFolder folder;
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const std::string good = OnnxConvolution(Weights(), Bias(), kSide);
  expect(RefusalOf(folder.path() / "none.onnx"), "none.onnx");
  expect(RefusalOf(SaveOnnx(folder, "net.txt", good)), "name it .onnx or .pt");
  expect(RefusalOf(SaveOnnx(folder, "text.onnx", "no network at all")), "is not an ONNX model");
  expect(RefusalOf(SaveOnnx(folder, "empty.onnx", "")), "empty.onnx");
  expect(RefusalOf(SaveOnnx(folder, "text.pt", "no network at all")), "is not a TorchScript");
  for (size_t size : {size_t{1}, good.size() / 3, good.size() / 2, good.size() - 1}) {
    EXPECT_NE(RefusalOf(SaveOnnx(folder, "cut.onnx", good.substr(0, size))), "") << size;
  }
  expect(RefusalOf(SaveOnnx(folder, "half.onnx", OnnxConvolution(Weights(), Bias(), kSide, 10))),
         "export it in fp32");
  expect(
      RefusalOf(SaveOnnx(folder, "two.onnx", OnnxConvolution({1, 0, 0, 0, 1, 0}, {0, 0}, kSide))),
      "first output is 1 x 2 x 64 x 64");
  expect(RefusalOf(SaveOnnx(folder, "fixed.onnx", good), {128}), "fixed to 64 pixels");
  expect(RefusalOf(SaveOnnx(folder, "size.onnx", good), {5}), "16 to 4096");
  expect(RefusalOf(SaveScript(folder, "flat.pt", R"(
def forward(self, image):
    return image[0, 0]
)")),
         "first output is [64, 64]");
  expect(RefusalOf(SaveScript(folder, "number.pt", R"(
def forward(self, image):
    return 3
)")),
         "returns no tensor");
  expect(RefusalOf(SaveScript(folder, "fails.pt", R"(
def forward(self, image):
    return image.reshape([1, 1, 7, 7])
)")),
         "does not run on an input of 1 x 3 x 64 x 64");
  expect(RefusalOf(SaveScript(folder, "nan.pt", R"(
def forward(self, image):
    return torch.log(image[:, 0:1] * 0.0 - 1.0)
)")),
         "not finite");
}

TEST(SalientNetwork, ReadsTheInputOfAnOnnxFile) {
  const auto input = ReadOnnxInput(OnnxConvolution(Weights(), Bias(), 320));
  ASSERT_TRUE(input.has_value());
  EXPECT_EQ(input->height, 320);
  EXPECT_EQ(input->channels, 3);
  EXPECT_TRUE(input->fp32);
  EXPECT_EQ(ReadOnnxInput(OnnxConvolution(Weights(), Bias(), 0))->height, 0);
  EXPECT_FALSE(ReadOnnxInput("").has_value());
  // Any prefix and any changed byte: no crash.
  const std::string bytes = OnnxConvolution(Weights(), Bias(), 320);
  for (size_t i = 0; i < bytes.size(); ++i) {
    ReadOnnxInput(bytes.substr(0, i));
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0xff);
    ReadOnnxInput(changed);
  }
}

}  // namespace
}  // namespace simwright::asset_lift
