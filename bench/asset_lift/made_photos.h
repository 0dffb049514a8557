#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "asset_lift/camera/elevation.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/camera.h"
#include "core/mesh.h"
#include "core/random.h"

namespace simwright::bench {

// An object of a catalogue with a category of the knowledge base.
struct CatalogueObject {
  std::string name, category;
  core::TexturedMesh visual;  // metres, z up, true size
  asset_lift::CategoryPrior prior;
};

// Returns the objects of the catalogues that are 3 cm to 0.9 m long and whose name is in the
// knowledge base, one per name, in the catalogues' order, at most `limit`.
std::vector<CatalogueObject> HouseholdObjects(const std::vector<std::filesystem::path>& catalogues,
                                              int limit);

// Returns background images: the wood of examples/coffee.png beside the cup, and brick.png,
// grass.png, gravel.png of `folder` (scikit-image's photos) if they are there. Those are grey and
// are tinted.
std::vector<core::Image> Backgrounds(const std::filesystem::path& folder);

// A rendered photo with its ground truth.
struct MadePhoto {
  core::Image photo;        // RGB
  asset_lift::Matte matte;  // ground truth
  core::Camera camera;      // in the object's world
  double elevation = 0.0;   // rad, of the line of sight to the object's middle
  double focal = 0.0;       // pixels
};

// Renders the object from a random azimuth and from 5 to 45 degrees above, filling 60 to 75 % of
// 400 x 400 pixels of a field of view of 35 degrees, on a random crop of one of the backgrounds.
MadePhoto MakePhoto(const CatalogueObject& object, const std::vector<core::Image>& backgrounds,
                    core::Rng* rng);

}  // namespace simwright::bench
