// `simwright scene certify`: verdicts, files and words, on scenes of every form; bad input is
// rejected.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "manipulation/grasp_file.h"
#include "program.h"
#include "robot/trajectory_file.h"
#include "running_program.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

// A pantry with its assets, made once.
class SceneCertifyCommand : public testing::Test {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  static void CertifiesAScene();
  static void CertifiesEveryObject();
  static void TakesPoses();
  static void SearchesForSolvableScenes();
  static void TakesProvedGrasps();
  static void RefusesWhatDoesNotFit();
  static void LeavesNothingWhenStopped();

  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    generated_ = RunProgram("scene generate --type pantry_shelf --count 1 --seed 77 --quiet -o " +
                            At("pantry"));
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string At(const std::string& name) { return (folder_->path() / name).string(); }
  static Outcome Certify(const std::string& source, const std::string& task,
                         const std::string& rest) {
    return RunProgram("scene certify " + source + " --task \"" + task + "\" " + rest);
  }
  static json Report(const std::string& folder) {
    return json::parse(core::ReadFile(fs::path(At(folder)) / "certificate.json"));
  }

  static inline core::TemporaryFolder* folder_ = nullptr;
  static inline Outcome generated_;
};

void SceneCertifyCommand::CertifiesAScene() {
  const Outcome made =
      Certify(At("pantry"), "Please bring the pear to the front!", "-o " + At("proof"));
  ASSERT_EQ(made.code, 0) << made.text;
  EXPECT_NE(made.text.find("bring the pear to the front"), std::string::npos) << made.text;
  const json report = Report("proof");
  EXPECT_EQ(report["task"], "bring the pear to the front");
  ASSERT_EQ(report["scenes"].size(), 1u);
  const json& scene = report["scenes"][0];
  ASSERT_TRUE(scene["solvable"].get<bool>()) << scene;
  EXPECT_EQ(scene["verdict"], "solvable");
  EXPECT_EQ(scene["object"].get<std::string>().rfind("pear", 0), 0u);
  EXPECT_TRUE(scene["proof"]["success"].get<bool>());
  EXPECT_TRUE(scene["proof"]["held"].get<bool>());
  EXPECT_LE(scene["proof"]["others_moved_mm"].get<double>(), 5.0);
  EXPECT_GE(scene["difficulty"].get<double>(), 0.0);
  EXPECT_LT(scene["difficulty"].get<double>(), 1.0);
  EXPECT_LT(scene["world_from_robot"]["translation"][0].get<double>(), -0.3);
  const fs::path file = fs::path(At("proof")) / scene["trajectory"].get<std::string>();
  const robot::JointTrajectory trajectory = robot::ReadTrajectory(file);
  EXPECT_EQ(trajectory.joints.size(), 8u);
  EXPECT_GT(trajectory.times.back(), 1.0);
  EXPECT_TRUE(fs::exists(fs::path(At("proof")) / "certificates.png"));
  // The same seed gives the same bytes, on any number of threads.
  ASSERT_EQ(Certify(At("pantry"), "move a pear to the front",
                    "--threads 1 --no-pictures --quiet -o " + At("again"))
                .code,
            0);
  EXPECT_EQ(core::ReadFile(fs::path(At("again")) / scene["trajectory"].get<std::string>()),
            core::ReadFile(file));
}

void SceneCertifyCommand::CertifiesEveryObject() {
  const Outcome made =
      Certify(At("pantry"), "lift the pear", "--every --no-pictures --json -o " + At("every"));
  ASSERT_EQ(made.code, 0) << made.text;
  const json report = Report("every");
  EXPECT_GT(report["scenes"].size(), 1u);
  int solvable = 0;
  for (const json& one : report["scenes"]) {
    EXPECT_EQ(one["instances"], 1);
    if (one["solvable"].get<bool>()) {
      ++solvable;
      EXPECT_TRUE(fs::exists(fs::path(At("every")) / one["trajectory"].get<std::string>()));
    } else {
      EXPECT_FALSE(one["reason"].get<std::string>().empty());
      EXPECT_FALSE(one.contains("trajectory"));
      EXPECT_EQ(one["difficulty"], 1.0);
    }
    if (one["verdict"] != "blocked" || !one["blockers_verified"].get<bool>()) continue;
    EXPECT_FALSE(one["blockers"].empty());
  }
  EXPECT_EQ(report["solvable"], solvable);
  EXPECT_GT(solvable, 0);
}

void SceneCertifyCommand::TakesPoses() {
  // A pear on the top board alone, 5 cm behind the front.
  core::WriteFile(At("pantry/poses.json"),
                  R"([{"asset": "assets/shelf_pantry", "translation": [0, 0, 0]},
                      {"asset": "assets/pear", "name": "lunch", "translation": [-0.08, 0, 0.818]}])");
  const Outcome made = Certify(At("pantry/poses.json"), "bring the pear to the front",
                               "--base=-0.6,0,0.3,0 --no-pictures -o " + At("poses"));
  ASSERT_EQ(made.code, 0) << made.text;
  const json scene = Report("poses")["scenes"][0];
  EXPECT_EQ(scene["object"], "lunch");
  EXPECT_TRUE(scene["solvable"].get<bool>()) << scene;
  EXPECT_EQ(scene["world_from_robot"]["translation"][2], 0.3);
}

// The grasp of a certificate is one of the asset's proved grasps, which may lie in another folder.
void SceneCertifyCommand::TakesProvedGrasps() {
  fs::create_directories(At("grasps"));
  const std::string file = At("grasps/pear.json");
  ASSERT_EQ(
      RunProgram("grasps " + At("pantry/assets/pear") + " --count 12 --quiet -o " + file).code, 0);
  const auto certify = [](const std::string& rest, const std::string& output) {
    const Outcome made =
        Certify(At("pantry/poses.json"), "bring the pear to the front",
                "--base=-0.6,0,0.3,0 --no-pictures --json " + rest + " -o " + At(output));
    EXPECT_EQ(made.code, 0) << made.text;
    const json scene = Report(output)["scenes"][0];
    EXPECT_TRUE(scene["solvable"].get<bool>()) << scene;
    return std::make_pair(made.text, scene);
  };
  const manipulation::GraspSet set = manipulation::ReadGraspSet(file);
  const auto is_proved = [&](const json& scene) {
    const json& pose = scene["plan"]["grasp"];
    const auto at = pose["translation"].get<std::vector<double>>();
    const auto turn = pose["quaternion_wxyz"].get<std::vector<double>>();
    Eigen::Isometry3d grasp(Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]));
    grasp.translation() = Eigen::Vector3d(at[0], at[1], at[2]);
    return std::any_of(set.grasps.begin(), set.grasps.end(), [&](const auto& proved) {
      return proved.object_from_tool.isApprox(grasp, 1e-6);
    });
  };
  const auto [with_text, with] = certify("--grasps " + At("grasps"), "with_grasps");
  EXPECT_TRUE(is_proved(with)) << with["plan"]["grasp"];
  EXPECT_EQ(with_text.find("certify-sampled-grasps"), std::string::npos) << with_text;
  const auto [without_text, without] = certify("", "without_grasps");
  EXPECT_FALSE(is_proved(without));
  EXPECT_NE(without_text.find("certify-sampled-grasps"), std::string::npos) << without_text;
  EXPECT_NE(without_text.find("1 of 1 objects have no proved grasps (pear)"), std::string::npos);
  fs::copy(file, At("pantry/assets/pear/grasps.json"));
  EXPECT_TRUE(is_proved(certify("", "own_grasps").second));
  EXPECT_FALSE(is_proved(certify("--grasps none", "no_grasps").second));
  fs::remove(At("pantry/assets/pear/grasps.json"));
  const Outcome missing = Certify(At("pantry/poses.json"), "lift the pear",
                                  "--grasps " + At("nowhere") + " -o " + At("bad"));
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.text.find("is no folder of grasps"), std::string::npos) << missing.text;
}

// The objectives of `scene search` agree with the certificate of the scene that it starts from.
void SceneCertifyCommand::SearchesForSolvableScenes() {
  const auto search = [](const std::string& objective, const std::string& task,
                         const std::string& output) {
    return RunProgram("scene search --type pantry_shelf --steps 4 --iterations 1 --branching 1 " +
                      ("--quiet --assets " + At("pantry/assets")) + " --start " + At("pantry") +
                      " --objective " + objective + " --task \"" + task + "\" -o " + At(output));
  };
  const auto report_of = [](const std::string& output) {
    return json::parse(core::ReadFile(fs::path(At(output)) / "search.json"));
  };
  const std::string task = "bring the pear to the front";
  const Outcome solvable = search("solvable", task, "easy");
  ASSERT_EQ(solvable.code, 0) << solvable.text;
  EXPECT_EQ(report_of("easy")["start_reward"], 1.0);
  EXPECT_EQ(report_of("easy")["final_reward"], 1.0);
  EXPECT_EQ(report_of("easy")["iterations"].size(), 0u) << "the start is solvable already";
  const Outcome hard = search("hard-but-solvable", task, "hard");
  EXPECT_NE(hard.code, 2) << hard.text;
  const double difficulty = Report("proof")["scenes"][0]["difficulty"];
  EXPECT_NEAR(report_of("hard")["start_reward"].get<double>(), 0.5 + 0.5 * difficulty, 0.1);
  EXPECT_GE(report_of("hard")["best_reward"], report_of("hard")["start_reward"]);
  // A scene without the object that the task names.
  core::WriteFile(At("pantry/no_pear.json"),
                  R"([{"asset": "assets/shelf_pantry", "translation": [0, 0, 0]}])");
  const Outcome none = RunProgram(
      "scene search --type pantry_shelf --steps 4 --iterations 1 --branching 1 --quiet --assets " +
      At("pantry/assets") + " --start " + At("pantry/no_pear.json") +
      " --objective solvable --task \"" + task + "\" -o " + At("none"));
  EXPECT_NE(none.code, 2) << none.text;
  EXPECT_EQ(report_of("none")["start_reward"], 0.0);
  EXPECT_EQ(search("solvable", "sing a song", "bad").code, 1);
}

void SceneCertifyCommand::RefusesWhatDoesNotFit() {
  const auto expect = [](const Outcome& outcome, const std::string& says) {
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
    EXPECT_FALSE(fs::exists(At("bad")));
  };
  const std::string out = "-o " + At("bad"), pantry = At("pantry");
  expect(Certify(pantry, "sing a song", out), "not understood");
  expect(Certify(pantry, "bring the pear", out), "not understood");
  expect(Certify(pantry, "bring to the front", out), "not understood");
  expect(Certify(pantry, "bring the aple to the front", out), "error: --task: nothing");
  expect(Certify(pantry, "bring the aple to the front", out), "apple");
  expect(Certify(pantry, "bring the teapot to the front", out), "the objects are");
  expect(Certify(pantry, "bring the 40th pear to the front", out), "no 40th pear");
  expect(Certify(pantry, "lift the pear", "--base 1,2 " + out), "four numbers");
  expect(Certify(pantry, "lift the pear", "--candidates 0 " + out), "--candidates");
  expect(Certify(pantry, "lift the pear", "--scene 9 " + out), "9");
  expect(Certify(At("missing"), "lift the pear", out), "no such scene");
  core::WriteFile(At("pantry/escape.json"),
                  R"([{"asset": "assets/pear", "name": "../../pear", "translation": [0, 0, 1]}])");
  expect(Certify(At("pantry/escape.json"), "lift the pear", out), "without slashes");
  core::WriteFile(At("pantry/far.json"),
                  R"([{"asset": "assets/pear", "translation": [1e20, 0, 1]}])");
  expect(Certify(At("pantry/far.json"), "lift the pear", out), "within 10 km");
  EXPECT_EQ(Certify(pantry, "lift the pear", "-o " + At("proof")).code, 1);  // it exists
  for (const std::string& over : {pantry, At("")}) {
    const Outcome refused = Certify(pantry, "lift the pear", "--force -o " + over);
    EXPECT_EQ(refused.code, 1) << refused.text;
    EXPECT_NE(refused.text.find("its own input"), std::string::npos) << refused.text;
    EXPECT_TRUE(fs::exists(At("pantry/part_00000.h5")));
  }
}

void SceneCertifyCommand::LeavesNothingWhenStopped() {
  RunningProgram program(
      "scene certify " + At("pantry") + " --task \"lift the pear\" --every -o " + At("stopped"),
      At("stopped.log"));
  const auto staging = [] { return HasStagingFolderOf(At("stopped")); };
  ASSERT_TRUE(program.WaitFor(staging));
  program.EndBy(SIGINT);
  EXPECT_FALSE(staging()) << "it left a folder";
}

TEST_F(SceneCertifyCommand, ProvesOrNamesWhatIsInTheWay) {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  CertifiesAScene();
  CertifiesEveryObject();
  TakesPoses();
  TakesProvedGrasps();
  SearchesForSolvableScenes();
  RefusesWhatDoesNotFit();
  LeavesNothingWhenStopped();
}

}  // namespace
}  // namespace simwright::workflows
