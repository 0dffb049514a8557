#include "validation/check_folder.h"

#include <algorithm>
#include <cstdio>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/finding_text.h"
#include "core/parallel.h"

namespace simwright::validation {
namespace fs = std::filesystem;
namespace {

void Gather(const fs::path& folder, std::vector<fs::path>* found) {
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && !entry.is_symlink()) entries.push_back(entry.path());
  }
  std::sort(entries.begin(), entries.end());
  for (const fs::path& entry : entries) {
    if (assets::IsAssetFolder(entry)) {
      found->push_back(entry);
    } else {
      Gather(entry, found);
    }
  }
}

CheckReport Checked(const fs::path& folder, const FolderCheck& check) {
  try {
    return check(folder);
  } catch (const core::Error& error) {
    return {folder.string(), {{"readable", core::Severity::kError, folder.string(), error.what()}}};
  }
}

}  // namespace

std::vector<fs::path> AssetFoldersIn(const fs::path& folder) {
  std::vector<fs::path> found;
  Gather(folder, &found);
  return found;
}

std::vector<CheckReport> CheckFolders(const std::vector<fs::path>& folders,
                                      core::Progress* progress, const FolderCheck& check) {
  std::vector<CheckReport> reports(folders.size());
  progress->Stage("check", static_cast<int>(folders.size()));
  core::ParallelFor(static_cast<int>(folders.size()), [&](int i) {
    core::CheckCancelled();
    reports[static_cast<size_t>(i)] = Checked(folders[static_cast<size_t>(i)], check);
    progress->Advance();
  });
  progress->Finish();
  return reports;
}

std::string CheckSummary(const std::vector<CheckReport>& reports) {
  std::string table;
  int passed = 0, warned = 0;
  for (const CheckReport& report : reports) {
    passed += report.passed();
    warned += report.grade() == Grade::kWarnings;
    char line[64];
    std::snprintf(line, sizeof(line), "%-22s", GradeSentence(report.grade()));
    table += line + report.subject + "\n";
    for (const core::Finding& row : NotableResults(report)) {
      char figure[48];
      std::snprintf(figure, sizeof(figure), "%.4g ", row.figure);
      table += std::string("    ") +
               (row.severity == core::Severity::kError ? "FAIL  " : "warn  ") + row.code + ": " +
               core::Truncated(figure + row.sentence, 200) + "\n";
    }
  }
  char line[96];
  std::snprintf(line, sizeof(line), "%d of %zu pass, %d of them with warnings\n", passed,
                reports.size(), warned);
  return table + line;
}

}  // namespace simwright::validation
