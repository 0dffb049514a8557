// Real PartNet-Mobility folders, whose licence keeps them out of this repository: the tests run if
// SIMWRIGHT_PARTNET names a folder of them, grouped by kind or not.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/files.h"
#include "tests/workflows/program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

std::vector<fs::path> PartnetFolders() {
  std::vector<fs::path> folders;
  const char* root = std::getenv("SIMWRIGHT_PARTNET");
  if (root == nullptr || !fs::is_directory(root)) return folders;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().filename() == "mobility.urdf") folders.push_back(entry.path().parent_path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

// Nine of ten become assets that pass their check.
TEST(PartnetFolders, BecomeAssets) {
  const std::vector<fs::path> folders = PartnetFolders();
  if (folders.empty()) GTEST_SKIP() << "SIMWRIGHT_PARTNET names no folder of PartNet-Mobility";
  const core::TemporaryFolder out;
  size_t passed = 0;
  std::vector<double> seconds;
  for (const fs::path& folder : folders) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome made =
        RunProgram("import --quiet " + folder.string() + " -o " + out.path().string());
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    const bool good = made.code == 0 &&
                      RunProgram("check " + (out.path() / folder.filename()).string()).code == 0;
    passed += good;
    std::printf("%s %s %.1f s%s\n", folder.parent_path().filename().c_str(),
                folder.filename().c_str(), seconds.back(),
                good ? "" : ("\n  " + made.text).c_str());
  }
  std::sort(seconds.begin(), seconds.end());
  std::printf("%zu of %zu, median %.1f s, worst %.1f s\n", passed, folders.size(),
              seconds[seconds.size() / 2], seconds.back());
  EXPECT_GE(10 * passed, 9 * folders.size());
}

}  // namespace
}  // namespace simwright
