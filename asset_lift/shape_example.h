#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/view_frame.h"
#include "core/mesh.h"
#include "core/random.h"
#include "geometry/voxel_solid.h"
#include "render/light.h"
#include "render/scene.h"

namespace simwright::asset_lift {

// Sizes that the shape network and what it learns from agree on.
inline constexpr int kCropSide = 64;         // pixels of the crop that the network sees
inline constexpr int kDepthCells = 64;       // cells of its volume along w
inline constexpr double kDepthReach = 1.25;  // the volume spans w in [-reach, reach]

// A mesh made ready to be photographed often: one unit from its middle to its farthest corner, the
// middle at the origin.
class TrainingObject {
 public:
  // `stretch` scales the axes first: more forms from few meshes. Throws core::Error for a mesh
  // without extent.
  TrainingObject(core::TexturedMesh mesh, const Eigen::Vector3d& stretch);

  const core::TexturedMesh& mesh() const { return mesh_; }
  const render::Scene& scene() const { return scene_; }
  const geometry::VoxelSolid& solid() const { return *solid_; }

 private:
  core::TexturedMesh mesh_;
  render::Scene scene_;
  std::unique_ptr<geometry::VoxelSolid> solid_;
};

// A camera on a random orbit about a training object, the way people photograph: from -5 to 70
// degrees above, mostly 5 to 45; field of view 12 to 50 degrees; the object whole in the picture.
core::Camera RandomPhotoCamera(core::Rng* rng, int side, double* elevation);

// Light from above with a random key.
render::SphericalHarmonicsLight RandomLight(core::Rng* rng);

// What the network sees and what it should say. Pixels (kCropSide^2), rows from the top.
struct ShapeExample {
  ViewFrame frame;
  double elevation = 0.0;  // rad, of the sight line to the object's middle
  render::SphericalHarmonicsLight light;
  std::vector<std::uint8_t> picture;    // RGBA, sRGB
  std::vector<std::uint8_t> back;       // RGB of the last surface behind each pixel, as seen from
                                        // behind, in the same light; 0 where nothing is
  std::vector<std::uint8_t> occupancy;  // (kDepthCells x side x side): 255 full; nearest w first
};

// A photo of the object from a random camera, in random light, and the truth behind it.
ShapeExample MakeShapeExample(const TrainingObject& object, core::Rng* rng);

// The crop of `frame` out of a picture of the object: RGBA, kCropSide pixels a side. `photo` and
// `alpha` as large as the camera's picture.
core::Image CropPicture(const core::Image& photo, const core::Image& alpha, const ViewFrame& frame);

}  // namespace simwright::asset_lift
