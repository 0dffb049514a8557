#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/view_frame.h"
#include "core/mesh.h"
#include "core/random.h"
#include "geometry/voxel_solid.h"
#include "render/light.h"
#include "render/scene.h"

namespace simwright::asset_lift {

// The sizes that the shape network and its training data share.
inline constexpr int kCropSide = 64;         // pixels per side of the network's input crop
inline constexpr int kDepthCells = 64;       // cells of its output volume along w
inline constexpr double kDepthReach = 1.25;  // the volume spans w in [-reach, reach]

// A mesh prepared for repeated rendering: normalized to one unit from its centre to its farthest
// corner, with the centre at the origin.
class TrainingObject {
 public:
  // `stretch` scales the axes first, which varies the shapes of few meshes. Throws core::Error for
  // a mesh with zero extent.
  TrainingObject(core::TexturedMesh mesh, const Eigen::Vector3d& stretch);

  const core::TexturedMesh& mesh() const { return mesh_; }
  const render::Scene& scene() const { return scene_; }
  const geometry::VoxelSolid& solid() const { return *solid_; }

 private:
  core::TexturedMesh mesh_;
  render::Scene scene_;
  std::unique_ptr<geometry::VoxelSolid> solid_;
};

// Returns a random orbit camera about a training object, with the distribution of people's photos:
// from -5 to 70 degrees above, mostly 5 to 45; field of view 12 to 50 degrees; the whole object in
// the image.
core::Camera RandomPhotoCamera(core::Rng* rng, int side, double* elevation);

// Returns light from above with a random key light.
render::SphericalHarmonicsLight RandomLight(core::Rng* rng);

// The network's input and its ground truth. Pixels (kCropSide^2), rows from the top.
struct ShapeExample {
  ViewFrame frame;
  double elevation = 0.0;  // rad, of the line of sight to the object's centre
  render::SphericalHarmonicsLight light;
  std::vector<std::uint8_t> picture;    // RGBA, sRGB
  std::vector<std::uint8_t> back;       // RGB of the last surface behind each pixel, as seen from
                                        // behind, in the same light; 0 for background
  std::vector<std::uint8_t> occupancy;  // (kDepthCells x side x side): 255 full; nearest w first
};

// Renders the object from a random camera in random light, with the ground truth.
ShapeExample MakeShapeExample(const TrainingObject& object, core::Rng* rng);

// Returns the crop of `frame` from an image of the object: RGBA, kCropSide pixels per side. `photo`
// and `alpha` have the camera's image size.
core::Image CropImage(const core::Image& photo, const core::Image& alpha, const ViewFrame& frame);

}  // namespace simwright::asset_lift
