#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pipeline/photo_run.h"
#include "pipeline/photo_run_folder.h"
#include "pipeline/photo_run_record.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// What all stages came to, read from the files that they wrote (docs/run.md names the members).
// Names no place outside the folder. `refusal`: why there is no trajectory; empty: there is one.
// Throws core::Error where a stage's file is gone or damaged.
nlohmann::ordered_json PhotoRunReport(const PhotoRunRequest& request, const PhotoRunFolder& folder,
                                      const tasks::Task& task, const std::vector<RunStage>& stages,
                                      const std::string& refusal);

// The command that repeats the run, options that are not the default's alone.
std::string PhotoRunCommand(const PhotoRunRequest& request);

}  // namespace simwright::pipeline
