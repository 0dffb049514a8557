#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "scene/metrics/feature_matrix.h"

namespace simwright::scene {

// A feature extractor for label renders, whose features compare sets of scenes. It is Simwright's
// own network (scene/metrics/feature_network) or a user's.
class SceneFeatures {
 public:
  // Loads the weights of Simwright's own network. Throws core::Error if they are missing, damaged,
  // or of another network.
  static SceneFeatures Load(const std::filesystem::path& weights);
  // Loads a TorchScript module that maps images (B x 3 x side x side; RGB in [0, 1]) to features
  // (B x D, or a shape that flattens to it), such as Inception's pooled features (`side`: 299
  // pixels) or AlexNet's convolutions (224). The module must normalize its input itself. Throws
  // core::Error if the module is missing or not TorchScript, or if side < 1.
  static SceneFeatures LoadTorchScript(const std::filesystem::path& module, int side);
  ~SceneFeatures();
  SceneFeatures(SceneFeatures&&) noexcept;
  SceneFeatures& operator=(SceneFeatures&&) noexcept;

  // Returns true for Simwright's own network, false for a user's.
  bool own() const;
  // Returns the name for reports: "simwright scene features", or the module's file and image size.
  const std::string& name() const;

  // Returns the label render `picture` (RGB), resized to the network's input size.
  core::Image Resized(const core::Image& picture) const;
  // Returns the features (N x D) of N images that Resized returned. Throws core::Error if there is
  // no image, for images of another size or not RGB, and if a user's module fails or does not
  // return N rows of finite numbers.
  FeatureMatrix Of(const std::vector<core::Image>& pictures) const;

 private:
  struct Network;
  explicit SceneFeatures(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::scene
