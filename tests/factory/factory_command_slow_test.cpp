// `simwright factory`, whole: kills, several workers, wrong plans.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <set>
#include <string>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "factory/factory_plan.h"
#include "factory/factory_record.h"
#include "tasks/task_file.h"
#include "tasks/task_names.h"
#include "tests/workflows/program.h"
#include "tests/workflows/running_program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr char kPlan[] = R"({"tasks": 30, "seed": 3, "sources": [
  {"library": ["drawer_unit", "box_with_lid"], "count": 2},
  {"library": ["mug", "apple", "can", "book", "toy_block"], "count": 14}]})";

size_t Records(const fs::path& folder) {
  size_t count = 0;
  if (!fs::exists(folder / "done")) return 0;
  for (const auto& entry : fs::directory_iterator(folder / "done")) {
    count += entry.path().extension() == ".json" ? 1 : 0;
  }
  return count;
}

fs::path FirstRecord(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder / "done")) {
    if (entry.path().extension() == ".json") return entry.path();
  }
  return {};
}

// Two kills at any time lose at most what was being made: every asset and task is there in the end,
// and what was recorded before a kill is not made again.
TEST(FactoryCommand, SurvivesKills) {
  const core::TemporaryFolder folder;
  const fs::path plan = folder.path() / "plan.json", output = folder.path() / "made";
  core::WriteFile(plan, kPlan);
  std::string arguments = "factory " + plan.string() + " -o " + output.string() + " --quiet";
  fs::path first;  // a record from before the first kill
  fs::file_time_type first_time;
  for (const size_t enough : {3u, 8u}) {
    RunningProgram program(arguments, folder.path() / "log");
    ASSERT_TRUE(program.WaitFor([&] { return Records(output) >= enough; }));
    program.EndBy(SIGKILL);
    if (first.empty()) {
      first = FirstRecord(output);
      first_time = fs::last_write_time(first);
    }
    arguments = "factory -o " + output.string() + " --resume --quiet";
  }
  const Outcome outcome = RunProgram("factory -o " + output.string() + " --resume --json");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const core::Json json = core::ParseJson(outcome.text, "stdout");
  EXPECT_EQ(json["planned"], 16);
  EXPECT_EQ(json["made"], 16);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_GE(json["kept"].get<int>(), 8);
  EXPECT_GE(json["tasks"].get<int>(), 30);
  EXPECT_EQ(fs::last_write_time(first), first_time);
  int assets = 0;
  for (const auto& entry : fs::directory_iterator(output / "assets")) {
    EXPECT_TRUE(assets::IsAssetFolder(entry.path())) << entry.path();
    ++assets;
  }
  EXPECT_EQ(assets, 16);
  const tasks::TaskSet set = tasks::ReadTaskFile(output / "tasks.json");
  EXPECT_EQ(static_cast<int>(set.tasks.size()), json["tasks"].get<int>());
  std::set<std::string> names;
  for (const tasks::Task& task : set.tasks) {
    EXPECT_TRUE(task.valid()) << task.name;
    EXPECT_TRUE(names.insert(task.name).second) << task.name;
  }
  const std::string page = core::ReadFile(output / "index.html");
  EXPECT_NE(page.find("16 of 16"), std::string::npos);
  EXPECT_EQ(page.find("http-equiv=\"refresh\""), std::string::npos);
  // The folder is not started again by mistake, nor with another plan.
  EXPECT_EQ(RunProgram("factory " + plan.string() + " -o " + output.string()).code, 1);
  core::WriteFile(plan, R"({"sources": [{"library": ["mug"]}]})");
  const Outcome other = RunProgram("factory " + plan.string() + " --resume -o " + output.string());
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.text.find("another plan"), std::string::npos) << other.text;
}

// Two workers in one folder share the work, and both end when all is made.
TEST(FactoryCommand, IsSharedByWorkers) {
  const core::TemporaryFolder folder;
  const fs::path plan = folder.path() / "plan.json", output = folder.path() / "made";
  core::WriteFile(plan, R"({"sources": [{"library": ["mug", "cup", "book"], "count": 8}]})");
  RunningProgram first(
      "factory " + plan.string() + " -o " + output.string() + " --json --threads 1",
      folder.path() / "log");
  ASSERT_TRUE(first.WaitFor([&] { return fs::exists(output / "plan.json"); }));
  const Outcome second =
      RunProgram("factory --resume --json --threads 1 -o " + output.string(), "/dev/null");
  ASSERT_EQ(second.code, 0) << second.text;
  const core::Json json = core::ParseJson(second.text, "stdout");
  EXPECT_EQ(json["made"], 8);
  EXPECT_EQ(Records(output), 8u);
  // Both ended, and each says that all is made.
  EXPECT_TRUE(first.WaitFor([&] {
    return core::ReadFile(folder.path() / "log").find("\"made\": 8") != std::string::npos;
  }));
}

TEST(FactoryCommand, RefusesWrongPlans) {
  const core::TemporaryFolder folder;
  const fs::path plan = folder.path() / "plan.json";
  const auto refusal = [&](const std::string& text) {
    core::WriteFile(plan, text);
    const Outcome outcome =
        RunProgram("factory " + plan.string() + " -o " + (folder.path() / "made").string());
    EXPECT_EQ(outcome.code, 1) << text;
    EXPECT_FALSE(fs::exists(folder.path() / "made")) << text;
    return outcome.text;
  };
  EXPECT_NE(refusal(R"({"sources": [{"library": ["flux_capacitor"]}]})").find("flux_capacitor"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"sources": [{"photos": "nowhere"}]})").find("nowhere"), std::string::npos);
  EXPECT_NE(refusal(R"({"sources": []})").find("no asset"), std::string::npos);
  EXPECT_NE(refusal(R"({"sources": [{"library": ["mug"], "cuont": 3}]})").find("cuont"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"theme": "kitchen", "sources": []})").find("either"), std::string::npos);
  EXPECT_NE(refusal(R"({"variants": 2, "sources": [{"library": ["mug"]}]})").find("variants"),
            std::string::npos);
  EXPECT_EQ(RunProgram("factory plan.json --assets 3 -o made").code, 2);
  EXPECT_NE(refusal("{\"sources\": [").find("plan.json"), std::string::npos);
  EXPECT_EQ(RunProgram("factory --theme xyzzyq -o " + (folder.path() / "made").string()).code, 1);
  EXPECT_EQ(RunProgram("factory --resume -o " + (folder.path() / "made").string()).code, 1);
}

}  // namespace

namespace factory {
namespace {

TEST(FactoryPlan, OfAThemeHasDistinctAssetsAndSomeWithJoints) {
  core::Findings findings;
  const FactoryPlan plan = PlanOfTheme({"kitchen", 200, 500, 0, 1}, &findings);
  ASSERT_EQ(plan.items.size(), 200u);
  std::set<std::string> names, kinds;
  for (const FactoryItem& item : plan.items) {
    EXPECT_TRUE(names.insert(item.name).second) << item.name;
    kinds.insert(item.kind);
  }
  EXPECT_GT(kinds.size(), 15u);
  EXPECT_TRUE(kinds.contains("mug"));
  EXPECT_EQ(PartCount(plan), 20);
  // Every part has an articulated asset and others, and the parts together use most assets.
  std::set<int> used;
  for (int part = 0; part < PartCount(plan); ++part) {
    const std::vector<int> items = ItemsOfPart(plan, part);
    EXPECT_GE(items.size(), 8u);
    used.insert(items.begin(), items.end());
  }
  EXPECT_GT(used.size(), 150u);
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / "plan.json", PlanText(plan));
  EXPECT_EQ(PlanText(ReadPlanText(folder.path() / "plan.json")), PlanText(plan));
}

// Names are those that tasks accept, and none is that of a texture variant of another asset.
TEST(FactoryPlan, NamesFilesForTasks) {
  const core::TemporaryFolder folder;
  fs::create_directories(folder.path() / "meshes");
  for (const char* name : {"001", "chair", "chair_000", "a b c"}) {
    core::WriteFile(folder.path() / "meshes" / (std::string(name) + ".obj"),
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  core::WriteFile(folder.path() / "plan.json", R"({"sources": [{"files": "meshes"}]})");
  core::Findings findings;
  const FactoryPlan plan = ReadFactoryPlan(folder.path() / "plan.json", &findings);
  ASSERT_EQ(plan.items.size(), 4u);
  std::set<std::string> names;
  for (const FactoryItem& item : plan.items) {
    EXPECT_TRUE(tasks::IsAssetName(item.name)) << item.name;
    EXPECT_TRUE(names.insert(item.name).second) << item.name;
  }
  EXPECT_FALSE(names.contains("chair_000"));
}

TEST(AssetRecord, IsReadAsWritten) {
  AssetRecord record;
  record.name = "mug_1";
  record.source = "library";
  record.category = "mug";
  record.folder = "assets/mug_1";
  record.variants = {"assets/mug_1_000"};
  record.failures = {{"it fell \"over\"", "seed 100001"}};
  record.seconds = 1.5;
  const core::TemporaryFolder folder;
  const fs::path file = folder.path() / "mug_1.json";
  EXPECT_FALSE(ReadAssetRecord(file).has_value());
  core::WriteFile(file, AssetRecordText(record));
  const auto read = ReadAssetRecord(file);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(AssetRecordText(*read), AssetRecordText(record));
  core::WriteFile(file, "{\"name\": 3}");
  EXPECT_THROW(ReadAssetRecord(file), core::Error);
}

}  // namespace
}  // namespace factory
}  // namespace simwright
