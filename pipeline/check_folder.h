#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/check.h"

namespace simwright::pipeline {

// Asset folders in `folder` and in the folders below it, by name; what lies in an asset is its own.
std::vector<std::filesystem::path> AssetFoldersIn(const std::filesystem::path& folder);

// Checks all of them, side by side. One that cannot be read is a report with the one row
// "readable", which fails.
std::vector<CheckReport> CheckFolders(const std::vector<std::filesystem::path>& folders,
                                      core::Progress* progress);

// A line an asset, with the rows of it that warn or fail below, and a line that counts.
std::string CheckSummary(const std::vector<CheckReport>& reports);

}  // namespace simwright::pipeline
