#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "scene/metrics/feature_matrix.h"

namespace simwright::scene {

// A feature extractor for label renders, for comparing sets of scenes: our own network
// (scene/metrics/feature_network) or a user's.
class SceneFeatures {
 public:
  // Loads weights of our own network. Throws core::Error if they are missing, damaged, or of
  // another network.
  static SceneFeatures Load(const std::filesystem::path& weights);
  // Loads a TorchScript module from (B x 3 x side x side), RGB in [0, 1], to (B x D) or a shape
  // that flattens to it: Inception's pooled features (side 299), AlexNet's convolutions (224). The
  // module does its own normalization. Throws core::Error if it is missing or not TorchScript, or
  // if side < 1.
  static SceneFeatures LoadTorchScript(const std::filesystem::path& module, int side);
  ~SceneFeatures();
  SceneFeatures(SceneFeatures&&) noexcept;
  SceneFeatures& operator=(SceneFeatures&&) noexcept;

  // Returns true for our own network.
  bool own() const;
  // Returns the name for reports: "simwright scene features", or the module's file and side.
  const std::string& name() const;

  // Returns a label render (RGB) resized to the network's input size.
  core::Image Resized(const core::Image& picture) const;
  // Returns the features (N x D) of images of Resized. Throws core::Error for other images, and if
  // a user's module fails or does not return N rows of finite numbers.
  FeatureMatrix Of(const std::vector<core::Image>& pictures) const;

 private:
  struct Network;
  explicit SceneFeatures(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::scene
