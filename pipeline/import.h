#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/asset_builder.h"
#include "pipeline/check.h"
#include "pipeline/true_size.h"

namespace simwright::pipeline {

struct ImportOptions {
  std::string category;  // empty: from the file's name, else the catch-all "object"
  // 'x', 'y', 'z', or 0: as the file says (glTF, DAE), else y for OBJ and DAE, z for STL and PLY,
  // unless the other suits the thing clearly better (up_axis.h). URDFs have z up.
  char up = 0;
  double unit = 1.0;    // metres a file unit; 1: the file is in metres (as glTF and DAE are)
  bool unit_stated = false;  // by the user: any size that comes out is meant
  double height = 0.0;  // m, > 0: scale to this height instead (of a URDF: joints at zero)
  StatedSize size;      // scale to this size instead
  physics_params::StatedPhysics stated;
  std::uint64_t seed = 1;
  bool force = false;   // replace outputs that exist
  bool resume = false;  // keep outputs that exist, and import the others
  bool check = true;    // check each asset; one that fails is refused
  std::string only;     // catalogues: take pieces whose id or name contains this
  int limit = 0;        // catalogues: at most so many pieces; 0: all
};

// One thing to import: a mesh file, a piece of a catalogue, or a URDF with joints.
struct ImportItem {
  std::filesystem::path mesh;  // file; for a catalogue piece the .sh3f; or the .urdf
  int piece = -1;              // index into the catalogue's pieces, or -1
  std::string name;            // of the asset's folder
  // Of a URDF: no mesh is read from outside this folder. Empty: its package, or its own.
  std::filesystem::path root = {};
};

struct ImportOutcome {
  std::string name;
  std::filesystem::path folder;  // where the asset is; empty when refused
  std::string refusal;           // the reason, when refused
  core::Findings findings;       // what was guessed, left out or refused; place: the asset's name
  bool kept = false;             // was there already, and stays
  StageSeconds seconds;
  std::optional<CheckReport> check;
};

// Meshes, URDFs, folders of them (searched through) and catalogues, as a list with distinct names.
// A folder with one URDF, PartNet-Mobility's or GAPartNet's, or a ROS or Gazebo package is one
// thing, named like the folder; meshes beside URDFs belong to them and are not listed.
// Throws core::Error for an input that does not exist or holds nothing to import, and for a package
// with several URDFs, which it names, or with none but a xacro.
std::vector<ImportItem> ListImports(const std::vector<std::filesystem::path>& inputs,
                                    const ImportOptions& options);

// Imports all items in parallel, each into output/NAME. A mesh that cannot become an asset is
// refused with its reason and does not stop the others. Catalogue pieces take the catalogue's
// true sizes; of others, a size that is absurd for the category is refused, with what to do, unless
// it is stated. After Ctrl-C what was done stays, and the others are refused as stopped. Throws
// core::Error when an output exists and neither `force` nor `resume` is set.
std::vector<ImportOutcome> ImportAll(const std::vector<ImportItem>& items,
                                     const std::filesystem::path& output,
                                     const ImportOptions& options, core::Progress* progress);

// The mesh of an item in the world: metres, z up, as large as it is stated to be. Of a URDF, all that
// it shows with its joints at zero; no file outside `root` is read for it.
core::TexturedMesh ReadInWorld(const std::filesystem::path& mesh,
                               const physics_params::Category& category,
                               const ImportOptions& options, core::Findings* findings,
                               const std::filesystem::path& root = {});

}  // namespace simwright::pipeline
