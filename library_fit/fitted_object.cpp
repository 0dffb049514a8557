#include "library_fit/fitted_object.h"

#include <cmath>
#include <map>
#include <string>

#include "core/error.h"
#include "library_fit/fit_loss.h"
#include "render/forward.h"
#include "texture/photo_projection.h"

namespace simwright::library_fit {
namespace {

constexpr int kComparedSide = 96;  // pixels per side of the crop in which shapes are compared
constexpr int kColorSide = 160;    // of the crop from which colours are taken
constexpr int kHeightSteps = 4;    // of the size towards a given height
constexpr int kLeastPixels = 6;    // of a look, for a mean colour

FitTarget TargetOf(const FitPhoto& photo, int side) {
  return MakeFitTarget(asset_lift::CropView(photo.photo, photo.alpha, photo.frame, side));
}

// Returns the camera for the pixels of the photo's crop of `side` pixels.
core::Camera ToCrop(core::Camera camera, const FitPhoto& photo, int side) {
  const double scale = side / (2.0 * photo.frame.half);
  camera.cx = (camera.cx - photo.frame.center_x + photo.frame.half) * scale;
  camera.cy = (camera.cy - photo.frame.center_y + photo.frame.half) * scale;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.width = camera.height = side;
  return camera;
}

// Returns the mean colours in the photo of the looks that it shows, by their names.
std::map<std::string, Eigen::Vector3f> SeenColors(const SeenInstance& seen_instance,
                                                  const FitPhoto& photo) {
  const FitTarget target = TargetOf(photo, kColorSide);
  const core::TexturedMesh mesh = InstanceMesh(seen_instance.instance);
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  const render::ForwardBuffers seen =
      render::RenderForward(scene, ToCrop(seen_instance.camera, photo, kColorSide));
  std::map<std::string, std::pair<Eigen::Vector3f, int>> sums;
  for (size_t i = 0; i < seen.triangle.size(); ++i) {
    if (seen.triangle[i] < 0 || target.opacity[i] < 0.9f) continue;
    const auto material =
        static_cast<size_t>(mesh.triangle_material[static_cast<size_t>(seen.triangle[i])]);
    auto& [sum, count] =
        sums.try_emplace(mesh.materials[material].name, Eigen::Vector3f::Zero(), 0).first->second;
    sum += target.color[i];
    ++count;
  }
  std::map<std::string, Eigen::Vector3f> colors;
  for (const auto& [look, entry] : sums) {
    if (entry.second >= kLeastPixels) colors[look] = entry.first / static_cast<float>(entry.second);
  }
  return colors;
}

// Gives the looks of a mesh their mean colours in the photo.
void TakeColors(const std::map<std::string, Eigen::Vector3f>& colors,
                std::vector<core::Material>* materials) {
  for (core::Material& material : *materials) {
    const auto seen = colors.find(material.name);
    if (seen != colors.end()) material.base_color.head<3>() = seen->second;
  }
}

// Returns the mesh of `instance`, the seen one or that in another size, with the photo's colours
// where it shows the surface and the colours of its looks elsewhere. The triangles keep their
// order.
core::TexturedMesh Painted(const SeenInstance& seen, const Instance& instance,
                           const FitPhoto& photo,
                           const std::map<std::string, Eigen::Vector3f>& colors) {
  core::TexturedMesh mesh = InstanceMesh(instance);
  core::Camera camera = seen.camera;
  camera.world_from_camera.translation() *=
      core::Bounds(mesh.mesh).sizes().z() /
      core::Bounds(InstanceMesh(seen.instance).mesh).sizes().z();
  TakeColors(colors, &mesh.materials);
  std::vector<Eigen::Vector3f> hidden(mesh.mesh.vertices.size(), Eigen::Vector3f::Constant(0.5f));
  for (size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    const auto material = static_cast<size_t>(mesh.triangle_material[t]);
    for (const int corner : mesh.mesh.triangles[t]) {
      hidden[static_cast<size_t>(corner)] = mesh.materials[material].base_color.head<3>();
    }
  }
  return texture::ProjectPhotos(mesh.mesh, {{camera, photo.photo, photo.alpha}}, hidden);
}

// Shows the painted mesh on the links whose triangles it lists in their order. Translucent looks
// stay plain.
void TakeTexture(const core::TexturedMesh& painted, std::vector<assets::ArticulatedLink>* links) {
  size_t first = 0;
  for (assets::ArticulatedLink& link : *links) {
    core::TexturedMesh& visual = link.visual;
    const size_t count = visual.mesh.triangles.size();
    const auto photo = static_cast<int>(visual.materials.size());
    for (int& material : visual.triangle_material) {
      if (visual.materials[static_cast<size_t>(material)].base_color.w() >= 1.0f) material = photo;
    }
    visual.materials.push_back({"photo", Eigen::Vector4f::Ones(), 0});
    visual.textures = painted.textures;
    const auto uv = painted.corner_uvs.begin() + static_cast<std::ptrdiff_t>(3 * first);
    visual.corner_uvs.assign(uv, uv + static_cast<std::ptrdiff_t>(3 * count));
    first += count;
  }
}

}  // namespace

FittedMesh TexturedFit(const FittedInstance& fit, const FitPhoto& photo) {
  core::TexturedMesh mesh = InstanceMesh(fit.instance);
  core::Camera camera = PhotoCamera(fit, photo);
  const Eigen::Vector3d middle = core::Bounds(mesh.mesh).center();
  const Eigen::Vector3d eye = camera.position() - middle;
  const Eigen::Isometry3d turn(
      Eigen::AngleAxisd(-M_PI / 2 - std::atan2(eye.y(), eye.x()), Eigen::Vector3d::UnitZ()));
  core::Transform(Eigen::Affine3d(turn), &mesh.mesh);
  camera.world_from_camera = turn * camera.world_from_camera;
  const Eigen::Hyperplane<double, 3> mirror(Eigen::Vector3d::UnitY(),
                                            core::Bounds(mesh.mesh).center());
  return {texture::ProjectPhoto(mesh.mesh, camera, photo.photo, photo.alpha, mirror), camera};
}

assets::ArticulatedAsset PaintedAsset(const SeenInstance& seen, const FitPhoto& photo,
                                      double height) {
  const FitKind& kind = FitKinds().at(static_cast<size_t>(seen.instance.kind));
  if (kind.articulated == nullptr) throw core::Error("a rigid kind has no joints", kind.name);
  Instance instance = seen.instance;
  // Some measures of the generators do not scale, such as those of handles and burners.
  for (int i = 0; height > 0.0 && i < kHeightSteps; ++i) {
    instance.size *= height / core::Bounds(InstanceMesh(instance).mesh).sizes().z();
  }
  assets::ArticulatedAsset asset = InstanceAsset(instance);
  const std::map<std::string, Eigen::Vector3f> colors = SeenColors(seen, photo);
  for (assets::ArticulatedLink& link : asset.links) {
    TakeColors(colors, &link.visual.materials);
  }
  TakeTexture(Painted(seen, instance, photo, colors), &asset.links);
  return asset;
}

core::TexturedMesh PaintedInstance(const SeenInstance& seen, const FitPhoto& photo) {
  return Painted(seen, seen.instance, photo, SeenColors(seen, photo));
}

assets::ArticulatedAsset FittedAsset(const FittedInstance& fit, const FitPhoto& photo,
                                     double height) {
  return PaintedAsset({fit.instance, PhotoCamera(fit, photo)}, photo, height);
}

core::TexturedMesh PaintedFit(const FittedInstance& fit, const FitPhoto& photo) {
  return PaintedInstance({fit.instance, PhotoCamera(fit, photo)}, photo);
}

PhotoAgreement AgreementWithPhoto(const core::TexturedMesh& mesh, const core::Camera& camera,
                                  const FitPhoto& photo) {
  const FitAgreement agreement =
      CompareWithPhoto(mesh, ToCrop(camera, photo, kComparedSide), TargetOf(photo, kComparedSide));
  return {agreement.iou, agreement.edge_error};
}

}  // namespace simwright::library_fit
