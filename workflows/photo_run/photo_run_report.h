#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "core/json.h"
#include "tasks/task.h"
#include "workflows/photo_run/photo_run.h"
#include "workflows/photo_run/photo_run_folder.h"
#include "workflows/photo_run/photo_run_record.h"

namespace simwright::workflows {

// Returns the results of all stages, read from their files (docs/run.md describes the members).
// Contains no path outside the folder. `refusal`: the reason why there is no trajectory; empty if
// there is one. Throws core::Error if a stage's file is missing or damaged.
core::OrderedJson PhotoRunReport(const PhotoRunRequest& request, const PhotoRunFolder& folder,
                                 const tasks::Task& task, const std::vector<RunStage>& stages,
                                 const std::string& refusal);

// Returns the findings of the asset and of the exported trajectory. Throws core::Error if a file is
// missing or damaged.
core::Findings PhotoRunFindings(const PhotoRunFolder& folder);

// Returns the command that repeats the run, with only the options that differ from the defaults.
std::string PhotoRunCommand(const PhotoRunRequest& request);

}  // namespace simwright::workflows
