#include "cli/findings_output.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "core/finding_json.h"
#include "core/finding_text.h"
#include "core/json.h"
#include "core/progress.h"
#include "core/ranks.h"

namespace simwright::cli {
namespace {

// Waits for the end of the ranks by their launcher; false if it is asked for meanwhile.
bool RanksMoment() {
  constexpr int kSteps = 30;
  for (int i = 0; i < kSteps && !core::CancelRequested(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return !core::CancelRequested();
}

}  // namespace

std::size_t LineWidth() {
  winsize size{};
  if (isatty(STDERR_FILENO) == 0) return 0;
  constexpr std::size_t kUsual = 80, kLeast = 40;
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsual;
  return std::max<std::size_t>(size.ws_col, kLeast);
}

void PrintError(const core::Finding& error, bool json) {
  const core::RankPlace& place = core::ThisRank();
  std::string text = core::FindingText(error, LineWidth());
  if (!place.leads()) {
    if (!RanksMoment()) return;
    text = "rank " + std::to_string(place.rank) + ": " + text;
  }
  std::fputs(text.c_str(), stderr);
  if (json && place.leads()) {
    PrintJson(core::OrderedJson{{"error", error.sentence}}, {error});
  }
}

void PrintFindings(const core::Findings& findings, const CommonOptions& common) {
  if (common.json) return;
  std::fflush(stdout);
  for (const core::Finding& finding : findings) {
    if (common.quiet && finding.severity != core::Severity::kError) continue;
    std::fputs(core::FindingText(finding, LineWidth()).c_str(), stderr);
  }
}

void PrintWarnings(const core::Findings& findings, const CommonOptions& common, int* notes) {
  core::Findings kept;
  for (const core::Finding& finding : findings) {
    if (finding.severity == core::Severity::kInfo) {
      ++*notes;
    } else {
      kept.push_back(finding);
    }
  }
  PrintFindings(kept, common);
}

void PrintJson(core::OrderedJson object, const core::Findings& findings) {
  object["findings"] = core::FindingsJson(findings);
  // Names and answers may contain invalid UTF-8.
  std::fputs(core::JsonText(object, core::InvalidUtf8::kReplace).c_str(), stdout);
}

void PrintJson(const std::string& object, const core::Findings& findings) {
  PrintJson(core::ParseOrderedJson(object, "the result"), findings);
}

}  // namespace simwright::cli
