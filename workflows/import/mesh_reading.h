#pragma once

#include <filesystem>
#include <string>

#include "assets/mesh_import.h"
#include "assets/urdf_reader.h"
#include "physics_params/knowledge_base.h"
#include "workflows/import/import.h"

namespace simwright::workflows {

// The mesh of an item in world coordinates: metres, z up, at its stated size.
struct ItemMesh {
  core::TexturedMesh visual;
  assets::PbrLook look;
  core::TexturedMesh as_read;  // z up, before its faces were repaired; if a report is wanted
};

// Reads the mesh of an item, removes and closes what does not belong to a surface
// (importers/loose_faces.h, hole_closing.h) and scales it. Of `urdf`, if given, returns all visuals
// with joints at zero, unchanged. Throws core::Error if the mesh cannot be read or has a size that
// cannot be simulated.
ItemMesh ReadInWorld(const std::filesystem::path& mesh_path, const assets::UrdfModel* urdf,
                     const physics_params::Category& category, const ImportOptions& options,
                     core::Findings* findings);

}  // namespace simwright::workflows
