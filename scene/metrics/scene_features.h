#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "scene/metrics/feature_matrix.h"

namespace simwright::scene {

// What turns label renders into the numbers by which sets of scenes are compared: our own network
// (scene/metrics/feature_network), or a user's.
class SceneFeatures {
 public:
  // Weights of our own network. Throws core::Error where they are missing, damaged, or another's.
  static SceneFeatures Load(const std::filesystem::path& weights);
  // A TorchScript module from (B x 3 x side x side), RGB in [0, 1], to (B x D) or what flattens to
  // it: Inception's pooled features (side 299), AlexNet's convolutions (224). What it subtracts or
  // divides by is its own affair. Throws core::Error: missing, no TorchScript, side < 1.
  static SceneFeatures LoadScript(const std::filesystem::path& module, int side);
  ~SceneFeatures();
  SceneFeatures(SceneFeatures&&) noexcept;
  SceneFeatures& operator=(SceneFeatures&&) noexcept;

  // Whether these are our network's.
  bool own() const;
  // As reports name them: "simwright scene features", or the module's file and side.
  const std::string& name() const;

  // A label render brought to the size that the network takes. RGB.
  core::Image Shrunk(const core::Image& picture) const;
  // Features of pictures as Shrunk gives them, (N x D). Throws core::Error for other pictures, and
  // where a user's module fails or gives anything else than N rows of finite numbers.
  FeatureMatrix Of(const std::vector<core::Image>& pictures) const;

 private:
  struct Network;
  explicit SceneFeatures(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::scene
