// Tasks for all library assets: as many, and on as many kinds, as docs/tasks.md states.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "assets/articulated_folder.h"
#include "core/files.h"
#include "program.h"
#include "tasks/task_file.h"

namespace simwright {
namespace {

// "mug_1" -> "mug"
std::string KindOf(const std::string& asset) {
  return asset.substr(0, asset.rfind('_'));
}

TEST(LibraryTasks, ThreeHundredOverAllKindsAreSound) {
  const core::TemporaryFolder folder;
  const std::string library = (folder.path() / "library").string();
  const std::string file = (folder.path() / "tasks.json").string();
  const Outcome made = RunProgram("library --kind everything --no-check --quiet -o " + library);
  ASSERT_EQ(made.code, 0) << made.text;
  const Outcome outcome = RunProgram("tasks " + library + " --count 320 --quiet -o " + file);
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const tasks::TaskSet set = tasks::ReadTaskFile(file);
  std::set<std::string> articulated, rigid;
  int longer = 0;
  for (const tasks::Task& task : set.tasks) {
    EXPECT_TRUE(task.valid()) << task.name;
    longer += task.subtasks.size() >= 2;
    for (const std::string& asset : task.assets) {
      const bool joints = assets::IsArticulatedAssetFolder(folder.path() / "library" / asset);
      (joints ? articulated : rigid).insert(KindOf(asset));
    }
  }
  EXPECT_GE(set.tasks.size(), 300u);
  EXPECT_GE(articulated.size(), 12u);
  EXPECT_GE(rigid.size(), 30u);
  EXPECT_GE(longer, 60);
}

}  // namespace
}  // namespace simwright
