#pragma once

#include <filesystem>

#include "asset_lift/lift.h"
#include "core/finding.h"

namespace simwright::pipeline {

// The lift's learned priors from the shipped weights, and from a user's TorchScript module for the
// view prior where `view_script` is not empty. What is not there is left out, with a finding that
// says how to get it. Throws core::Error for weights or a module that are damaged.
asset_lift::LiftPriors LoadLiftPriors(const std::filesystem::path& view_script,
                                      core::Findings* findings);

}  // namespace simwright::pipeline
