#pragma once

#include <filesystem>
#include <vector>

#include "assets/furniture_catalogue.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::importers {

// Reads a catalogue piece in world coordinates: metres, z up, at the catalogue's true size.
// Unreadable textures are omitted and reported to `findings` (may be null). Throws core::Error if
// the piece has no mesh.
core::TexturedMesh ReadCataloguePiece(const assets::FurnitureCatalogue& catalogue,
                                      const assets::CataloguePiece& piece,
                                      core::Findings* findings);

// Reads all readable pieces of the catalogue, in its order.
std::vector<core::TexturedMesh> ReadCatalogue(const std::filesystem::path& path,
                                              core::Progress* progress);

}  // namespace simwright::importers
