// `simwright view`: the content of every kind of path, compared with what the readers of the
// library give; drops against free fall; bad input.
#include "viewer/contents/view.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <sstream>

#include <nlohmann/json.hpp>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "sim/rigid_body.h"
#include "tests/assets/sample_asset.h"
#include "tests/workflows/program.h"
#include "tests/workflows/running_program.h"
#include "tests/workflows/scripted_run.h"
#include "viewer/contents/drop_replay.h"
#include "viewer/contents/rollout_view.h"
#include "viewer/contents/view_content.h"
#include "viewer/document.h"

namespace simwright::viewer {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

sim::RigidBody SampleBody() {
  return sim::BodyFromAsset(assets::SampleAsset());
}

TEST(DropReplay, FallsFreelyAndThenRestsInItsPlace) {
  const sim::RigidBody body = SampleBody();
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translation() << 0.3, -0.2, 0.0;
  DropOptions options;
  options.height = 0.08;
  const Timeline timeline =
      DropReplay({{"floor", &body, Eigen::Isometry3d(Eigen::Translation3d(5, 5, 0)), true},
                  {"box", &body, place, false}},
                 options);
  ASSERT_EQ(timeline.tracks.size(), 1u) << "the fixed body does not move";
  EXPECT_EQ(timeline.tracks[0].body, 1);
  ASSERT_EQ(timeline.rate, 50.0);
  for (int frame = 0; frame < 6; ++frame) {  // it meets the floor after 0.128 s
    const double t = frame / timeline.rate;
    const float* row = timeline.rows.data() + frame * timeline.width;
    EXPECT_NEAR(row[0], 0.3, 1e-6);
    EXPECT_NEAR(row[2], 0.08 - 0.5 * 9.81 * t * t, 6e-4) << frame;
  }
  const float* last = timeline.rows.data() + (timeline.frames() - 1) * timeline.width;
  EXPECT_NEAR(last[0], 0.3, 2e-3);
  EXPECT_NEAR(last[2], 0.0, 5e-4);
  EXPECT_GT(last[6], 0.9999f) << "upright";
  EXPECT_LT(timeline.frames(), 126) << "a drop at rest ends early";
  EXPECT_EQ(timeline.facts[1].second, "box");
}

TEST(DropReplay, RefusesInvalidInput) {
  const sim::RigidBody body = SampleBody();
  EXPECT_THROW(DropReplay({{"wall", &body, Eigen::Isometry3d::Identity(), true}}), core::Error);
  DropOptions options;
  std::string fault;
  EXPECT_TRUE(options.IsValid(&fault));
  options.height = -1.0;
  EXPECT_FALSE(options.IsValid(&fault));
  EXPECT_THROW(DropReplay({{"box", &body}}, options), core::Error);
}

core::Findings OwnFindingsOf(const fs::path& path, const fs::path& page) {
  ViewRequest request;
  request.path = path;
  request.html = page;
  core::Progress silent;
  return WriteView(request, &silent).findings;
}

TEST(ViewAsset, AnOpenSolidIsSaid) {
  const core::TemporaryFolder folder;
  assets::Asset asset = assets::SampleAsset();
  const fs::path closed = folder.path() / "closed", open = folder.path() / "open";
  fs::create_directories(closed);
  assets::WriteAsset(asset, closed);
  EXPECT_TRUE(OwnFindingsOf(closed, folder.path() / "closed.html").empty());
  asset.solid.triangles.pop_back();
  fs::create_directories(open);
  assets::WriteAsset(asset, open);
  const core::Findings said = OwnFindingsOf(open, folder.path() / "open.html");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].code, "view-solid-open");
  EXPECT_EQ(said[0].figure, 3.0) << "the edges of one triangle";
  EXPECT_NE(core::ReadFile(folder.path() / "open.html").find("view-solid-open"), std::string::npos);
  const Outcome told =
      RunProgram("view " + open.string() + " --html " + (folder.path() / "told.html").string());
  EXPECT_EQ(told.code, 0) << told.text;
  EXPECT_NE(told.text.find("[view-solid-open]"), std::string::npos) << told.text;
}

TEST(ViewFolder, WithNothingToShowIsOneLine) {
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / "notes.txt", "nothing");
  const Outcome refused = RunProgram("view " + folder.path().string());
  EXPECT_EQ(refused.code, 1);
  EXPECT_EQ(refused.text, "error: " + folder.path().string() +
                              ": holds nothing that the viewer shows (give a folder of assets, "
                              "scenes, tasks, a training or a run, or one with a URDF)\n");
}

class ViewScenes : public testing::Test {
 protected:
  void SetUp() override {
    assets::Asset asset = assets::SampleAsset();
    for (const std::string name : {"box", "shelf"}) {
      asset.name = name;
      fs::create_directories(folder_.path() / "assets" / name);
      assets::WriteAsset(asset, folder_.path() / "assets" / name);
    }
    scene::SceneShard shard;
    shard.vocabulary = {"test", 3, {"box", "shelf"}, {false, true}};
    shard.origin = {5, 0, "{}", "{}", "1"};
    for (int i = 0; i < 2; ++i) {
      scenes_.push_back(Objects(i));
      const auto width = static_cast<std::size_t>(3 * shard.vocabulary.TokenWidth());
      shard.tokens.resize(shard.tokens.size() + width);
      scene::EncodeScene(scenes_.back(), shard.vocabulary,
                         shard.tokens.data() + shard.tokens.size() - width);
      shard.attempts.push_back({3, 3, 0, true, true, 0.0, 0.0, 0.0});
    }
    shard.prompts = {"A scene with two boxes.", "A <b>second</b> scene."};
    scene::WriteShard(shard, folder_.path() / scene::ShardName(0));
  }

  static std::vector<scene::SceneObject> Objects(int i) {
    std::vector<scene::SceneObject> objects(3);
    objects[0].category = "shelf";
    objects[0].welded = true;
    objects[1].category = objects[2].category = "box";
    objects[1].world_from_object.translation() << 0.5, 0.25 * i, 0.0;
    objects[2].world_from_object.translation() << -0.5, 0.0, 0.0;
    objects[2].world_from_object.rotate(Eigen::AngleAxisd(0.5 + i, Eigen::Vector3d::UnitZ()));
    return objects;
  }

  core::TemporaryFolder folder_;
  std::vector<std::vector<scene::SceneObject>> scenes_;
};

TEST_F(ViewScenes, ADatasetIsReadSceneByScene) {
  const auto content = ReadViewContent(folder_.path());
  const core::OrderedJson& manifest = content->document().manifest;
  EXPECT_EQ(manifest["kind"], "scenes");
  ASSERT_EQ(manifest["worlds"].size(), 2u);
  EXPECT_FALSE(manifest["worlds"][0].contains("bodies")) << "read when it is shown";
  EXPECT_EQ(manifest["worlds"][1]["description"], "A <b>second</b> scene.");
  for (int i = 0; i < 2; ++i) {
    const core::OrderedJson bodies = content->Bodies(i);
    ASSERT_EQ(bodies.size(), 3u);
    EXPECT_EQ(bodies[2]["name"], "box_1");
    for (std::size_t k = 0; k < 3; ++k) {
      const scene::SceneObject& object = scenes_[static_cast<std::size_t>(i)][k];
      EXPECT_EQ(bodies[k]["fixed"].get<bool>(), object.welded);
      const auto model = bodies[k]["model"].get<std::size_t>();
      EXPECT_EQ(manifest["models"][model]["name"], object.category);
      for (int n = 0; n < 12; ++n) {
        EXPECT_NEAR(bodies[k]["pose"][static_cast<std::size_t>(n)].get<double>(),
                    object.world_from_object.matrix()(n / 4, n % 4), 1e-6);
      }
    }
  }
  EXPECT_EQ(content->Replay(1).tracks.size(), 2u);
}

TEST_F(ViewScenes, OneFileHoldsScenesAndDropsAndSaysWhatItLeavesOut) {
  ViewRequest request;
  request.path = folder_.path();
  request.html = folder_.path() / "scenes.html";
  request.most = 1;
  core::Progress silent;
  const ViewReport report = WriteView(request, &silent);
  EXPECT_EQ(report.entries, 1);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].code, "view-worlds-left-out");
  const std::string page = core::ReadFile(request.html);
  const std::size_t begin = page.find("id=\"manifest\">") + 14;
  const json manifest = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  ASSERT_EQ(manifest["worlds"].size(), 1u);
  EXPECT_EQ(manifest["worlds"][0]["bodies"].size(), 3u);
  const json& drop = manifest["worlds"][0]["timelines"][0];
  EXPECT_EQ(manifest["buffers"][drop["buffer"].get<std::size_t>()]["size"],
            drop["frames"].get<int>() * 14 * 4);
}

TEST_F(ViewScenes, PosesAndFoldersOfAssetsAreRead) {
  core::WriteFile(folder_.path() / "poses.json",
                  R"([{"asset": "assets/box", "translation": [0, 0, 0.5]}])");
  const auto poses = ReadViewContent(folder_.path() / "poses.json");
  EXPECT_EQ(poses->Bodies(0)[0]["pose"][11], 0.5);
  const auto assets = ReadViewContent(folder_.path() / "assets");
  EXPECT_EQ(assets->document().manifest["kind"], "assets");
  EXPECT_EQ(assets->WorldCount(), 2);
  core::WriteFile(folder_.path() / "assets/shelf/solid.obj", "v 0 0");
  const auto damaged = ReadViewContent(folder_.path() / "assets");
  EXPECT_EQ(damaged->WorldCount(), 1);
  EXPECT_EQ(damaged->document().manifest["findings"][0]["code"], "view-asset-not-read");
}

TEST_F(ViewScenes, WhatCannotBeShownIsRefusedInOneLine) {
  fs::create_directories(folder_.path() / "empty");
  core::WriteFile(folder_.path() / "a.txt", "text");
  core::WriteFile(folder_.path() / "a.json", "{\"tasks\": 3}");
  core::WriteFile(folder_.path() / "a.jsonl", "{}");
  core::WriteFile(folder_.path() / "assets/box/asset.json", "{\"form");
  for (const char* name : {"empty", "a.txt", "a.jsonl", "assets/box"}) {
    const Outcome outcome = RunProgram("view " + (folder_.path() / name).string());
    EXPECT_EQ(outcome.code, 1) << name;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
  }
  EXPECT_THROW(ReadViewContent(folder_.path() / "a.json"), core::Error);
  EXPECT_THROW(ReadViewContent(folder_.path() / "missing"), core::Error);
  const fs::path html = folder_.path() / "none" / "a.html";
  EXPECT_EQ(RunProgram("view --quiet " + folder_.path().string() + " --html " + html.string()).code,
            1);
}

TEST_F(ViewScenes, CtrlCEndsTheServer) {
  RunningProgram program("view " + folder_.path().string(), folder_.path() / "log");
  ASSERT_TRUE(program.WaitFor([&] {
    return fs::exists(folder_.path() / "log") &&
           core::ReadFile(folder_.path() / "log").find("http://127.0.0.1:") != std::string::npos;
  }));
  const Outcome outcome = program.EndBy(SIGINT);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

class ViewRuns : public workflows::ScriptedRuns {};

TEST_F(ViewRuns, ARolloutMovesRobotAndObjectAsItsFileSays) {
  const std::string poses = Pick() + "/poses.jsonl";
  const Outcome outcome =
      RunProgram("rollout --quiet " + Pick() + " --episodes 1 --poses " + poses);
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  fs::copy_file(poses, Path("alone.jsonl"));
  EXPECT_THROW(ReadViewContent(Path("alone.jsonl")), core::Error) << "no tasks.json is beside it";
  const auto content = ReadViewContent(poses);
  const auto training = ReadViewContent(Pick());
  fs::copy_file(poses, Path("poses.jsonl"));
  fs::remove(poses);
  EXPECT_EQ(training->WorldCount(), 2) << "the subtask's start and the rollout";
  const core::OrderedJson& world = content->document().manifest["worlds"][0];
  const core::OrderedJson& timeline = world["timelines"][0];
  std::istringstream lines(core::ReadFile(Path("poses.jsonl")));
  std::string line;
  std::getline(lines, line);
  ASSERT_EQ(world["bodies"].size(), 2u);
  const std::string& rows =
      content->document().buffers[timeline["buffer"].get<std::size_t>()].bytes;
  const auto width = timeline["width"].get<std::size_t>();
  ASSERT_EQ(width, 8u + 7u);
  std::size_t frame = 0;
  for (; std::getline(lines, line); ++frame) {
    const json moment = json::parse(line);
    float row[15];
    std::memcpy(row, rows.data() + frame * sizeof row, sizeof row);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(row[i], moment["q"][i].get<double>(), 1e-6);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(row[8 + i], moment["things"][0][i].get<double>(), 1e-6);
    }
    EXPECT_NEAR(row[14], moment["things"][0][3].get<double>(), 2e-5) << "w";
  }
  EXPECT_EQ(timeline["frames"].get<std::size_t>(), frame);
}

TEST(RolloutPoses, MutilatedFilesAreReadOrRefused) {
  const core::TemporaryFolder folder;
  const std::string text =
      R"({"format":1,"robot":"panda","task":"t","episode":0,"success":true,"rate":60,"joints":["a"],)"
      R"("things":[{"name":"b","joints":[]}],"subtasks":[{"name":"s","lines":1}]})"
      "\n"
      R"({"q":[0.5],"things":[[1,2,3,1,0,0,0]]})"
      "\n";
  const auto frames = [&](const std::string& mutilated) {
    core::WriteFile(folder.path() / "poses.jsonl", mutilated);
    try {
      return ReadRolloutPoses(folder.path() / "poses.jsonl").timeline.frames();
    } catch (const core::Error&) {
      return 0;
    }
  };
  EXPECT_EQ(frames(text), 1);
  for (std::size_t at = 0; at < text.size(); ++at) {
    EXPECT_LE(frames(text.substr(0, at)), 1);
    for (const char byte : {'9', '"', '[', '-', '\n', '\xff'}) {
      std::string changed = text;
      changed[at] = byte;
      EXPECT_LE(frames(changed), 1) << at << " " << byte;
    }
  }
}

TEST_F(ViewRuns, ATrainingRecordsAnEpisodeOfItsPolicies) {
  const auto content = ReadViewContent(Move());
  const core::OrderedJson& manifest = content->document().manifest;
  EXPECT_EQ(manifest["kind"], "run");
  ASSERT_EQ(manifest["worlds"].size(), 2u) << "two subtasks";
  EXPECT_TRUE(manifest["worlds"][0].contains("replay"));
  EXPECT_FALSE(manifest["worlds"][1].contains("replay"));
  EXPECT_TRUE(manifest["worlds"][0].contains("code"));
  EXPECT_TRUE(content->Charts().empty()) << "its policies have no log";
  const Timeline timeline = content->Replay(0);
  ASSERT_EQ(timeline.marks.size(), 2u);
  EXPECT_EQ(timeline.facts[1].second, "yes") << "the episode succeeds";
  // The object rises between the fingers, which then hold it: column 8 begins its pose.
  float highest = 0.0f, strongest = 0.0f;
  for (int frame = 0; frame < timeline.frames(); ++frame) {
    const float* row = timeline.rows.data() + frame * timeline.width;
    highest = std::max(highest, row[8 + 2]);
    strongest = std::max(strongest, row[timeline.contact_columns + 3]);
  }
  EXPECT_GT(highest, 0.03f);
  EXPECT_EQ(strongest, 2.0f);
}

TEST_F(ViewRuns, TasksStartWithTheRobotAtHome) {
  const auto content = ReadViewContent(fs::path(Pick()) / "tasks.json");
  const core::OrderedJson& world = content->document().manifest["worlds"][0];
  EXPECT_EQ(content->document().manifest["kind"], "tasks");
  EXPECT_EQ(world["bodies"][0]["positions"]["panda_joint4"].get<double>(),
            workflows::RobotOf("panda").home()[3]);
  EXPECT_EQ(world["bodies"][1]["name"], "block");
}

TEST_F(ViewRuns, TheCurvesOfATrainingAreReadWhileItRuns) {
  const auto content = ReadViewContent(Pick());
  const fs::path folder = fs::path(Pick()) / "1_pick_up_block";
  const std::string header =
      "iteration,samples,seconds,episodes,mean_return,mean_steps,success,success_low,success_high,"
      "examined,kl,learning_rate,policy_loss,value_loss,entropy,std,clipped_share,gradient_norm,"
      "explained_variance,samples_per_second,learner_share,dropped\n";
  core::WriteFile(folder / "training.csv",
                  header + "1,4096,2,45,1.5,30,0.25,0.1,0.4,,,,,,,,,,,,,0\n2,8192,4,9");
  const core::OrderedJson charts = content->Charts();
  fs::remove(folder / "training.csv");
  ASSERT_EQ(charts.size(), 2u);
  const core::OrderedJson& curve = charts[0]["curves"][0];
  EXPECT_EQ(curve["x"], core::OrderedJson::array({4096.0})) << "half a row is no row";
  EXPECT_EQ(curve["y"][0], 0.25);
  EXPECT_EQ(curve["high"][0], 0.4);
}

}  // namespace
}  // namespace simwright::viewer
