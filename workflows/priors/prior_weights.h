#pragma once

#include <filesystem>

#include "asset_lift/lift.h"
#include "core/finding.h"

namespace simwright::workflows {

// Loads the learned reconstruction priors from the shipped weights, and the view prior from the
// user's TorchScript module if `view_script` is not empty. A missing prior is omitted, with a
// finding that says how to get it. Throws core::Error for damaged weights or a damaged module.
asset_lift::LiftPriors LoadLiftPriors(const std::filesystem::path& view_script,
                                      core::Findings* findings);

}  // namespace simwright::workflows
