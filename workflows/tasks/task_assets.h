#pragma once

#include <string>
#include <vector>

#include "assets/semantic_model.h"
#include "core/finding.h"
#include "tasks/task.h"

namespace simwright::workflows {

// The assets under the names by which programs refer to them.
struct TaskAssets {
  std::vector<assets::SemanticModel> models;  // their `name` is that name
  std::vector<tasks::TaskAsset> listed;       // the same assets as tasks.json lists them
  core::Findings findings;                    // deficiencies of their files; place: the file
};

// Reads `arguments`, each PATH or NAME=PATH: an asset folder (ours, or PartNet-Mobility's), a URDF,
// or a folder of such folders, which are read in order of their names. The default name is that of
// the folder or of the URDF file. Throws core::Error if a path does not exist, two assets have the
// same name, a name is not valid in programs, or a URDF cannot be read.
TaskAssets ReadTaskAssets(const std::vector<std::string>& arguments);

}  // namespace simwright::workflows
