#pragma once

#include <string>
#include <vector>

#include "assets/semantic_model.h"
#include "core/finding.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// Assets under the names that programs call them by.
struct TaskAssets {
  std::vector<assets::SemanticModel> models;  // their `name` is the one
  std::vector<tasks::TaskAsset> listed;       // the same, as tasks.json lists them
  core::Findings findings;                    // what their files lack; place: the file
};

// Reads `arguments`, each PATH or NAME=PATH: an asset's folder (ours, or PartNet-Mobility's), a
// URDF, or a folder of such folders, which are taken in order of their names. Without a name a
// folder's is taken, a URDF's file's. Throws core::Error where there is nothing at a path, two
// assets bear one name, programs cannot call one by its name, or a URDF cannot be read.
TaskAssets ReadTaskAssets(const std::vector<std::string>& arguments);

}  // namespace simwright::pipeline
