#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pipeline/photo_run_folder.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// A photo's run as one HTML page without scripts or outside files: its pictures, its task, its
// success and times. `report` is PhotoRunReport's. Throws core::Error where a picture is gone.
std::string PhotoRunPage(const PhotoRunFolder& folder, const tasks::Task& task,
                         const nlohmann::ordered_json& report);

}  // namespace simwright::pipeline
