#pragma once

#include <filesystem>
#include <vector>

#include "assets/furniture_catalogue.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::pipeline {

// A piece as it stands in the world: metres, z up, at the catalogue's true size. Textures that
// cannot be read are left out and reported to `findings` (may be null). Throws core::Error where
// the piece has no mesh.
core::TexturedMesh ReadCataloguePiece(const assets::FurnitureCatalogue& catalogue,
                                      const assets::CataloguePiece& piece,
                                      core::Findings* findings);

// All pieces of the catalogue that can be read, in its order.
std::vector<core::TexturedMesh> ReadCatalogue(const std::filesystem::path& path,
                                              core::Progress* progress);

}  // namespace simwright::pipeline
