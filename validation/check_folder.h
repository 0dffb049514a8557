#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "validation/check_report.h"

namespace simwright::validation {

// Returns the asset folders in `folder` and its subfolders, sorted by name. Asset folders
// themselves are not searched.
std::vector<std::filesystem::path> AssetFoldersIn(const std::filesystem::path& folder);

// The check of an asset folder, such as CheckAsset.
using FolderCheck = std::function<CheckReport(const std::filesystem::path&)>;

// Checks all folders in parallel. The report of an unreadable folder has a single failed result,
// "readable".
std::vector<CheckReport> CheckFolders(const std::vector<std::filesystem::path>& folders,
                                      core::Progress* progress, const FolderCheck& check);

// Formats one line per asset, followed by its warnings and failures, and a final line with the
// counts.
std::string CheckSummary(const std::vector<CheckReport>& reports);

}  // namespace simwright::validation
