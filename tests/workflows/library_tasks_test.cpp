// Tasks for a library of many kinds.
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

// All articulated kinds and those rigid ones that are made in a second.
constexpr const char* kKinds =
    "all,apple,avocado,ball,battery,board_game_small,book,bottle,bowl,box,brick,butter,candle,can,"
    "cereal_box,chocolate_bar,cutting_board,die,egg,eraser,flashlight,fork,glass,jar,knife,lemon,"
    "marker,milk_carton,orange,pen,pencil,phone,plate,rolling_pin,ruler,saucer,screwdriver,soap,"
    "spoon,tissue_box,toast,tray,wooden_spoon";

TEST(LibraryTasks, ThreeHundredOverFortyKindsAreSound) {
  const core::TemporaryFolder folder;
  const std::string library = (folder.path() / "library").string();
  const std::string file = (folder.path() / "tasks.json").string();
  const Outcome made =
      RunProgram("library --kind " + std::string(kKinds) + " --no-check --quiet -o " + library);
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
