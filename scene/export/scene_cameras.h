#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/camera_spec.h"
#include "render/look_ranges.h"
#include "render/rigid_render.h"
#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

struct SceneCamerasOptions {
  render::LookRanges look;   // off by default; each object is one of its objects
  int samples_per_side = 1;  // N x N rays per pixel for the colours, 1 to 8
  bool floor = true;         // a floor at z = 0, with label 0

  // Returns false, with a line that names the value, if one is outside its range.
  bool IsValid(std::string* error) const;
};

// Segmentation ids of scenes: 0 is the floor, -1 nothing.
constexpr std::int32_t SceneObjectLabel(int object) {
  return object + 1;  // object: index into the scene's objects
}

// Cameras for scenes of a dataset, with the meshes of its assets prepared once. Immutable and
// thread-safe.
class SceneCameras {
 public:
  // `categories`: those that scenes have, such as a vocabulary's. `cameras`: mounted on "world".
  // Throws core::Error for a category without an asset, an invalid spec or another mount, naming
  // the camera, and for invalid options.
  SceneCameras(const AssetSet& asset_set, const std::vector<std::string>& categories,
               std::vector<render::CameraSpec> cameras, const SceneCamerasOptions& options = {});

  const std::vector<render::CameraSpec>& cameras() const { return cameras_; }

  // Renders a scene with all M cameras, distributed over threads; the look follows from `seed`.
  // `images`: (M). Throws core::Error for an object of another category, or another number of
  // images.
  void Render(const std::vector<SceneObject>& objects, std::uint64_t seed,
              const std::vector<render::ImageBuffers>& images) const;
  // Renders N scenes. `images`: (N x M), by scene, then camera; scene i has the seed `seed` + i.
  void RenderScenes(const std::vector<std::vector<SceneObject>>& scenes, std::uint64_t seed,
                    const std::vector<render::ImageBuffers>& images) const;

 private:
  // Returns the scene, and writes the cameras of its look.
  render::RigidScene Place(const std::vector<SceneObject>& objects, std::uint64_t seed,
                           std::vector<core::Camera>* cameras) const;

  std::map<std::string, std::shared_ptr<const render::RigidMesh>> meshes_;  // by category
  std::vector<render::CameraSpec> cameras_;
  SceneCamerasOptions options_;
};

}  // namespace simwright::scene
