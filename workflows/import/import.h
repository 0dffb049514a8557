#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "asset_build/asset_builder.h"
#include "asset_build/true_size.h"
#include "core/progress.h"
#include "validation/check.h"

namespace simwright::workflows {

struct ImportOptions {
  std::string category;  // empty: from the file's name, else "object"
  // The up axis: 'x', 'y', 'z', or 0: stated by the file (glTF, DAE), else y for OBJ and DAE and z
  // for STL and PLY, unless the other axis fits the object clearly better (up_axis.h). URDFs have z
  // up.
  char up = 0;
  double unit = 1.0;             // metres per file unit; 1: metres (as glTF and DAE are)
  bool unit_stated = false;      // by the user: no resulting size is refused
  double height = 0.0;           // m, > 0: scales to this height (a URDF's with joints at zero)
  asset_build::StatedSize size;  // scales to this size instead
  // A mesh of arbitrary scale, as generators make: it is scaled to the size sampled for its
  // category unless `height` or `size` is set.
  bool sampled_size = false;
  physics_params::StatedPhysics stated;
  asset_build::PartBudget budget;
  std::uint64_t seed = 1;
  bool force = false;   // replaces existing outputs
  bool resume = false;  // keeps existing outputs and imports the others
  bool check = true;    // checks each asset and refuses one that fails
  bool report = false;  // writes import.html beside each rigid asset: what was found and done
  std::string only;     // catalogues: imports pieces whose id or name contains this
  int limit = 0;        // catalogues: the maximum number of pieces; 0: all
  // For a mesh that another step made: the source in asset.json (empty: the file's name), the
  // findings of that step, which come first, and a function that adds files to the asset's folder
  // (may be empty), given the mesh in metres with z up.
  std::string source = {};
  core::Findings earlier = {};
  std::function<void(const core::TexturedMesh& mesh, const std::filesystem::path& folder)>
      add_files = {};
};

// One object to import: a mesh file, a piece of a catalogue, or a URDF with joints.
struct ImportItem {
  std::filesystem::path mesh;  // the mesh file, the .sh3f of a catalogue piece, or the .urdf
  int piece = -1;              // index into the catalogue's pieces, or -1
  std::string name;            // the asset folder's name
  // Meshes of a URDF outside this folder are not read. Empty: its package, or its own folder.
  std::filesystem::path root = {};
};

struct ImportOutcome {
  std::string name;
  std::filesystem::path folder;  // the asset's folder; empty if refused
  std::string refusal;           // the reason, if refused
  core::Findings findings;       // guesses, omissions and refusals; place: the asset's name
  bool kept = false;             // existed already and was not imported again
  asset_build::StageSeconds seconds;
  std::optional<validation::CheckReport> check;
};

// Lists the meshes, URDFs, folders (searched recursively) and catalogues in `inputs` as items with
// distinct names. A folder with one URDF, a PartNet-Mobility or GAPartNet folder, and a ROS or
// Gazebo package are each one item, named like the folder; meshes beside URDFs belong to them and
// are not listed. Throws core::Error for an input that does not exist or has nothing to import, and
// for a package with several URDFs, which the message names, or with only a xacro.
std::vector<ImportItem> ListImports(const std::vector<std::filesystem::path>& inputs,
                                    const ImportOptions& options);

// Imports all items in parallel, each into output/NAME. A mesh that cannot become an asset is
// refused with its reason and does not stop the others. Catalogue pieces have the catalogue's true
// sizes. Unless the user states a size, a mesh of a size that is implausible for its category is
// scaled (importers/file_scale.h), with a warning, and a URDF of such a size is refused. After
// Ctrl-C, finished assets are kept and the others are refused as stopped. Throws core::Error if an
// output exists and neither `force` nor `resume` is set.
std::vector<ImportOutcome> ImportAll(const std::vector<ImportItem>& items,
                                     const std::filesystem::path& output,
                                     const ImportOptions& options, core::Progress* progress);

}  // namespace simwright::workflows
