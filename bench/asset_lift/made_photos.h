#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "asset_lift/elevation.h"
#include "asset_lift/segmentation.h"
#include "core/camera.h"
#include "core/mesh.h"
#include "core/random.h"

namespace simwright::bench {

// A catalogue's object with a category of the knowledge base.
struct CatalogueObject {
  std::string name, category;
  core::TexturedMesh visual;  // metres, z up, true size
  asset_lift::CategoryPrior prior;
};

// The pieces of the catalogues that are 3 cm to 0.9 m long and whose name the knowledge base knows,
// one a name, in the catalogues' order, at most `limit`.
std::vector<CatalogueObject> HouseholdObjects(const std::vector<std::filesystem::path>& catalogues,
                                              int limit);

// Pictures that things are put in front of: the wood of examples/coffee.png beside the cup, and
// brick.png, grass.png, gravel.png of `folder` (scikit-image's photos) where they are there. Those
// are grey: each is dyed as such a surface is.
std::vector<core::Image> Backgrounds(const std::filesystem::path& folder);

// A photo whose truth is known.
struct MadePhoto {
  core::Image photo;        // RGB
  asset_lift::Matte matte;  // true
  core::Camera camera;      // in the object's world
  double elevation = 0.0;   // rad, of the sight line to the object's middle
  double focal = 0.0;       // pixels
};

// The object from a random side and from 5 to 45 degrees above, filling 60 to 75 % of 400 x 400
// pixels of a field of view of 35 degrees, before a random crop of one of the backgrounds.
MadePhoto MakePhoto(const CatalogueObject& object, const std::vector<core::Image>& backgrounds,
                    core::Rng* rng);

}  // namespace simwright::bench
