#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/random.h"
#include "library_fit/fit_kinds.h"
#include "render/light.h"

namespace simwright::twin {

// The pattern of a surface, evaluated in its own frame.
enum class SurfacePattern { kPlain, kNoise, kStripes, kDots, kChecks, kGrain };

struct SurfaceLook {
  SurfacePattern pattern = SurfacePattern::kPlain;
  Eigen::Vector3f color{0.6f, 0.6f, 0.6f}, other{0.4f, 0.4f, 0.4f};  // sRGB, [0, 1]
  double scale = 0.05;                                               // m, period of the pattern
  float strength = 0.0f;  // share of `other` where the pattern is 1
  std::uint32_t seed = 1;
};

// An object on a table.
struct TableObject {
  library_fit::Instance instance;  // unless `mesh` is set
  int mesh = -1;                   // index of a foreign mesh, or -1
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
  core::TexturedMesh visual;  // object frame, m, z up, standing on z = 0
  SurfaceLook look;           // mixed over the visual's own colours
  float gloss = 0.0f;         // weight of the highlight
};

// A table, or a floor, whose top is the plane z = 0.
struct Table {
  bool round = false, endless = false;
  Eigen::Vector2d half{0.6, 0.4};  // m; of a round one x is the radius
  double yaw = 0.0;                // rad
  double thickness = 0.03;         // m
  SurfaceLook look;
  int photo = -1;            // index of the photo on its top, or -1 for the look alone
  double photo_width = 1.0;  // m, mirrored beyond
};

// Objects on a table before a camera, in one light. Metres; z up, the table's top is z = 0.
struct TableScene {
  std::vector<TableObject> objects;
  Table table;
  core::Camera camera;
  render::SphericalHarmonicsLight light;
  Eigen::Vector3f sun_direction{0, 0, 1};  // unit, towards the sun
  float sun = 0.0f, sun_radius = 0.05f;    // strength; rad
  int background = -1;                     // index of a photo behind the table, or -1
  Eigen::AlignedBox2d background_crop;     // share of the photo's sides
  Eigen::Vector3f background_color{0.5f, 0.5f, 0.5f};
};

// The pictures and meshes from which scenes are made.
struct TableSceneSources {
  std::vector<core::Image> photos;         // RGB, of tables, walls, rooms; may be empty
  std::vector<core::TexturedMesh> meshes;  // m, z up, standing on z = 0; may be empty
};

struct TableSceneOptions {
  int least_objects = 3, most_objects = 8;
  int width = 256, height = 192;  // pixels
  double mesh_share = 0.25;       // probability of a foreign mesh, if there are any
  double recolored = 0.5;         // share of objects whose colours or patterns are not their own
  std::uint64_t first_seed = 1;   // of instances: within [first_seed, first_seed + seeds)
  std::uint64_t seeds = 999'999'999;

  bool IsValid(std::string* error) const;
};

// Returns the kinds of the library that stand or lie on tables: 4 to 55 cm long.
const std::vector<int>& TableKinds();

// Returns a random scene: objects apart from each other, all at least partly in the picture, seen
// from 12 to 65 degrees above.
TableScene SampleTableScene(const TableSceneSources& sources, const TableSceneOptions& options,
                            core::Rng* rng);

}  // namespace simwright::twin
