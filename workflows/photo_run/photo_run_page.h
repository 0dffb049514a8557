#pragma once

#include <string>

#include "core/json.h"
#include "tasks/task.h"
#include "workflows/photo_run/photo_run_folder.h"

namespace simwright::workflows {

// Returns a photo run as one HTML page without scripts or external files: its pictures, task,
// success rate and times. `report` is PhotoRunReport's. Throws core::Error if a picture is missing.
std::string PhotoRunPage(const PhotoRunFolder& folder, const tasks::Task& task,
                         const core::JsonField& report);

}  // namespace simwright::workflows
