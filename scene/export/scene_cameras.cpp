#include "scene/export/scene_cameras.h"

#include <utility>

#include "core/error.h"

namespace simwright::scene {
namespace {

constexpr int kMostSceneSamples = 8;           // per side
constexpr float kSceneFloorHeight = -0.0005f;  // m: below what stands on the floor at 0

std::vector<render::CameraSpec> CheckedForScenes(std::vector<render::CameraSpec> cameras,
                                                 const SceneCamerasOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "options of cameras");
  if (cameras.empty()) throw core::Error("a scene needs at least one camera");
  render::RequireValid(cameras);
  for (const render::CameraSpec& camera : cameras) {
    if (camera.mount == "world") continue;
    throw core::Error("camera '" + camera.name + "': a scene has no mount '" + camera.mount + "'",
                      "", "mount it on world");
  }
  return cameras;
}

}  // namespace

bool SceneCamerasOptions::IsValid(std::string* error) const {
  if (samples_per_side < 1 || samples_per_side > kMostSceneSamples) {
    if (error != nullptr) {
      *error = "samples_per_side is " + std::to_string(samples_per_side) +
               ", but must be from 1 to " + std::to_string(kMostSceneSamples);
    }
    return false;
  }
  return look.IsValid(error);
}

SceneCameras::SceneCameras(const AssetSet& asset_set, const std::vector<std::string>& categories,
                           std::vector<render::CameraSpec> cameras,
                           const SceneCamerasOptions& options)
    : cameras_(CheckedForScenes(std::move(cameras), options)), options_(options) {
  for (const std::string& category : categories) {
    meshes_[category] = std::make_shared<render::RigidMesh>(asset_set.At(category).visual);
  }
}

render::RigidScene SceneCameras::Place(const std::vector<SceneObject>& objects, std::uint64_t seed,
                                       std::vector<core::Camera>* cameras) const {
  render::SceneLook base;
  base.backdrop.floor = options_.floor;
  base.backdrop.floor_height = kSceneFloorHeight;
  base.cameras = cameras_;
  const render::SceneLook look =
      render::SampleLook(options_.look, base, static_cast<int>(objects.size()), seed);
  render::RigidScene scene;
  scene.backdrop = look.backdrop;
  scene.light = look.light;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto mesh = meshes_.find(objects[i].category);
    if (mesh == meshes_.end()) {
      throw core::Error("the cameras have no asset of this category", objects[i].category);
    }
    scene.Add(mesh->second, SceneObjectLabel(static_cast<int>(i)), objects[i].world_from_object);
    scene.SetLook(static_cast<int>(i), look.objects[i]);
  }
  for (const render::CameraSpec& camera : look.cameras) {
    cameras->push_back(render::CameraAt(camera, Eigen::Isometry3d::Identity()));
  }
  return scene;
}

void SceneCameras::Render(const std::vector<SceneObject>& objects, std::uint64_t seed,
                          const std::vector<render::ImageBuffers>& images) const {
  RenderScenes({objects}, seed, images);
}

void SceneCameras::RenderScenes(const std::vector<std::vector<SceneObject>>& scenes,
                                std::uint64_t seed,
                                const std::vector<render::ImageBuffers>& images) const {
  if (images.size() != scenes.size() * cameras_.size()) {
    throw core::Error("got buffers for " + std::to_string(images.size()) + " images, but " +
                      std::to_string(scenes.size()) + " scenes with " +
                      std::to_string(cameras_.size()) + " cameras");
  }
  std::vector<render::RigidScene> placed;
  std::vector<core::Camera> cameras;
  placed.reserve(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    placed.push_back(Place(scenes[i], seed + i, &cameras));
  }
  std::vector<render::RigidView> views;
  for (std::size_t i = 0; i < images.size(); ++i) {
    views.push_back({&placed[i / cameras_.size()], cameras[i], images[i]});
  }
  render::RigidRenderOptions options;
  options.samples_per_side = options_.samples_per_side;
  render::RenderRigidBatch(views, options);
}

}  // namespace simwright::scene
