#pragma once

#include <cstdint>
#include <vector>

#include "capture/capture_mat.h"
#include "capture/lens.h"
#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::capture {

// Settings of rendered photos of an object on a mat: the ground truth of a capture.
struct MatPhotoOptions {
  PaperSize paper = PaperSize::kA4;
  bool mat = true;          // false: the table alone
  bool fine_table = false;  // a table with details of millimetres, in which features are found
  Lens lens;                // of all photos
  double noise = 2.0;       // standard deviation, of 255
  int jpeg_quality = 92;
  int samples_per_side = 2;
  std::uint64_t seed = 1;
};

struct MatPhoto {
  core::Image photo;
  Eigen::Isometry3d world_from_camera;  // the truth
};

// Returns a box of one colour (sRGB) that stands on z = 0 around the z axis. `sides`: m.
core::TexturedMesh PlainBox(const Eigen::Vector3d& sides, const Eigen::Vector3f& color);

// Returns a box with a blotchy picture of its own on each side, that stands on z = 0 around the z
// axis. `sides`: m.
core::TexturedMesh PaintedBox(const Eigen::Vector3d& sides, std::uint64_t seed);

// Returns an open box with walls and a floor of thickness `wall` (m), its nine visible faces and
// its underside painted as those of PaintedBox: its hollow is not in its outlines. `sides`: m,
// outside.
core::TexturedMesh PaintedTray(const Eigen::Vector3d& sides, double wall, std::uint64_t seed);

// Returns a lens of `width` x `height` pixels, `longer_fov` (rad) over the longer side, with the
// barrel distortion and the off-centre principal point of a phone.
Lens PhoneLens(int width, int height, double longer_fov);

// Returns camera poses on rings around the origin: `count` poses over the elevations (rad) in turn,
// each jittered, at the distance at which a sphere of `radius` (m) fills the photo's shorter side.
std::vector<Eigen::Isometry3d> OrbitPoses(int count, const std::vector<double>& elevations,
                                          double radius, const Lens& lens, std::uint64_t seed);

// Renders an object that stands on the plane z = 0 at the mat's centre, with the mat on a table in
// a room, in an even light with contact shadows; then distorts, adds noise and compresses.
std::vector<MatPhoto> RenderMatPhotos(const core::TexturedMesh& object,
                                      const std::vector<Eigen::Isometry3d>& poses,
                                      const MatPhotoOptions& options);

}  // namespace simwright::capture
