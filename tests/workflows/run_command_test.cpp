// `run` at small scale: the files of a complete run, the agreement of its report and page with the
// other commands, resuming after being stopped and killed, and rejected inputs.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <tinyxml2.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

// An untrained policy usually closes a drawer, so that all stages have work to do.
constexpr const char* kTask = "close_drawer_unit_1_drawer_1";
const std::vector<std::string> kStages = {"lift",  "check",    "scene", "tasks",
                                          "train", "evaluate", "export"};

class RunCommand : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  json Json(const std::string& name) const { return json::parse(core::ReadFile(Path(name))); }
  static std::string Photo(const std::string& name) {
    return std::string(SIMWRIGHT_SOURCE_DIR) + "/examples/" + name;
  }
  std::string Arguments(const std::string& photo, const std::string& category,
                        const std::string& more) const {
    return "run " + photo + " --category " + category + " -o " + Path("out") +
           " --lift outline --quiet " + more;
  }
  // One line "error: ..." with `word`, exit code 1.
  void ExpectRefused(const std::string& arguments, const std::string& word) const {
    const Outcome outcome = RunProgram(arguments);
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << word << "\n" << outcome.text;
  }

  core::TemporaryFolder folder_;
};

// The bounds of a success rate's interval are the rates from which the observed rate is 1.96
// standard deviations away (Wilson 1927).
void ExpectWilson(const json& counts, const std::string& successes, const std::string& tries) {
  const double n = counts.at(tries), rate = counts.at(successes).get<double>() / n;
  for (const char* bound : {"low", "high"}) {
    const double p = counts.at(bound);
    EXPECT_NEAR(std::abs(rate - p), 1.959964 * std::sqrt(p * (1.0 - p) / n), 1e-6) << counts;
  }
}

// Returns the page without the data of its pictures.
std::string WithoutPictures(const std::string& page) {
  const std::string begin = ";base64,";
  std::string text;
  size_t at = 0;
  for (size_t next; (next = page.find(begin, at)) != std::string::npos;) {
    text += page.substr(at, next - at);
    at = page.find('"', next);
  }
  return text + page.substr(at);
}

void CheckPage(const std::string& page, const json& report) {
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(page.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  const std::string text = WithoutPictures(page);
  size_t pictures = 0, inlined = 0;
  for (size_t at = 0; (at = text.find("<img ", at)) != std::string::npos; ++at) ++pictures;
  for (size_t at = 0; (at = text.find(" src=\"data:image/", at)) != std::string::npos; ++at) {
    ++inlined;
  }
  EXPECT_EQ(pictures, 6u);  // photo, asset, task, furniture, curves, rollout
  EXPECT_EQ(inlined, pictures);
  for (const char* forbidden : {"http", "<script", "<link", "url(", SIMWRIGHT_SOURCE_DIR}) {
    EXPECT_EQ(text.find(forbidden), std::string::npos) << forbidden;
  }
  EXPECT_EQ(text.find(fs::temp_directory_path().string()), std::string::npos);
  char counts[64];
  std::snprintf(counts, sizeof(counts), "%d of %d", report["success"]["successes"].get<int>(),
                report["success"]["episodes"].get<int>());
  EXPECT_NE(text.find(counts), std::string::npos) << counts;
  EXPECT_NE(text.find("simwright run apple.jpg --category apple"), std::string::npos);
}

TEST_F(RunCommand, APhotoBecomesAReportAndAPageThatAgreeWithTheOtherCommands) {
  const std::string small = "--task " + std::string(kTask) + " --envs 8 --episodes 20 ";
  const Outcome run =
      RunProgram(Arguments(Photo("apple.jpg"), "apple", small + "--steps 2048 --json"));
  ASSERT_EQ(run.code, 0) << run.text;
  const json report = Json("out/report.json");
  EXPECT_EQ(json::parse(run.text), report);
  for (const char* file : {"apple/apple.urdf", "apple/preview.png", "check.json", "tasks.json",
                           "skill/1_close_drawer_unit_1_drawer_1/policy.pt", "rollout.png",
                           "poses.jsonl", "trajectory.yaml", "index.html", "viewer.html"}) {
    EXPECT_TRUE(fs::exists(Path("out/") + file)) << file;
  }

  const json asset = Json("out/apple/asset.json");
  EXPECT_EQ(report["asset"]["mass"], asset["mass"]);
  EXPECT_EQ(report["asset"]["size_m"], asset["size_m"]);
  EXPECT_EQ(report["check"]["passed"], true);
  EXPECT_EQ(report["scene"]["furniture"], "drawer_unit_1");
  EXPECT_EQ(report["training"]["subtasks"][0]["samples"], 2048);
  const Outcome rollout = RunProgram("rollout " + Path("out/skill") + " --episodes 20 --json");
  ASSERT_EQ(rollout.code, 0) << rollout.text;
  const json again = json::parse(rollout.text);
  for (const char* key : {"episodes", "successes", "low", "high", "mean_seconds"}) {
    EXPECT_EQ(report["success"][key], again[key]) << key;
  }
  ExpectWilson(report["success"], "successes", "episodes");
  ASSERT_EQ(report["success"]["subtasks"].size(), 1u);
  ExpectWilson(report["success"]["subtasks"][0], "succeeded", "tried");

  const json& trajectory = report["trajectory"];
  EXPECT_EQ(trajectory["replayed"], true);
  ASSERT_EQ(trajectory["joints"].size(), 8u);  // seven of the arm, one of the fingers
  for (const json& joint : trajectory["joints"]) {
    for (const char* quantity : {"position", "velocity", "acceleration", "jerk"}) {
      EXPECT_LE(joint[quantity]["share"].get<double>(), 1.0 + 1e-9) << joint;
    }
  }
  double seconds = 0.0;
  ASSERT_EQ(report["stages"].size(), kStages.size());
  for (size_t i = 0; i < kStages.size(); ++i) {
    EXPECT_EQ(report["stages"][i]["name"], kStages[i]);
    seconds += report["stages"][i]["seconds"].get<double>();
  }
  EXPECT_NEAR(report["seconds"].get<double>(), seconds, 1e-9);
  EXPECT_EQ(report.dump().find(folder_.path().string()), std::string::npos);
  CheckPage(core::ReadFile(Path("out/index.html")), report);

  // A second call repeats nothing, and other inputs are named.
  const std::string record = core::ReadFile(Path("out/run.json"));
  const std::string page = core::ReadFile(Path("out/index.html"));
  const Outcome resumed =
      RunProgram(Arguments(Photo("apple.jpg"), "apple", small + "--steps 2048 --resume"));
  EXPECT_EQ(resumed.code, 0) << resumed.text;
  EXPECT_EQ(core::ReadFile(Path("out/run.json")), record);
  EXPECT_EQ(core::ReadFile(Path("out/index.html")), page);
  const std::string same = small + "--steps 2048 ";
  ExpectRefused(Arguments(Photo("apple.jpg"), "apple", same), "--resume");
  ExpectRefused(Arguments(Photo("apple.jpg"), "orange", same + "--resume"),
                "--category apple, not orange");
  ExpectRefused(Arguments(Photo("orange.jpg"), "apple", same + "--resume"), "another photo");
  ExpectRefused(Arguments(Photo("apple.jpg"), "apple", small + "--steps 4096 --resume"),
                "--steps 2048, not 4096");
  ExpectRefused(Arguments(Photo("apple.jpg"), "apple", same + "--resume --height 0.07"),
                "--height none, not 0.07");
  EXPECT_EQ(core::ReadFile(Path("out/run.json")), record);
}

// Runs the program as a process, sends `signal` as soon as `ready` holds, and returns its exit
// status.
int RunUntil(const std::string& arguments, const std::function<bool()>& ready, int signal) {
  const pid_t child = fork();
  if (child == 0) {
    const int nothing = open("/dev/null", O_WRONLY);
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
    const std::string command = std::string("exec ") + SIMWRIGHT_PROGRAM + " " + arguments;
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  const auto latest = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!ready()) {
    if (waitpid(child, &status, WNOHANG) != 0) {
      ADD_FAILURE() << "ended before it could be stopped, with status " << status;
      return status;
    }
    if (std::chrono::steady_clock::now() > latest) {
      ADD_FAILURE() << "hung before it could be stopped";
      signal = SIGKILL;
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  kill(child, signal);
  waitpid(child, &status, 0);
  return status;
}

std::vector<std::string> Lines(const fs::path& file) {
  std::vector<std::string> lines;
  if (!fs::exists(file)) return lines;
  std::istringstream text(core::ReadFile(file));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST_F(RunCommand, StoppedAndKilledInTrainingItGoesOnWhereItWas) {
  // Two updates imitate: each takes seconds, however few its samples are.
  const std::string small =
      "--task " + std::string(kTask) + " --envs 2 --episodes 8 --target 0.99 --imitate 256 ";
  const auto with = [&](const std::string& more) {
    return Arguments(Photo("apple.jpg"), "apple", small + more);
  };
  const fs::path table = Path("out/skill/1_") + kTask + "/training.csv";
  const auto rows = [&](size_t count) {
    return [&table, count] { return Lines(table).size() > count; };
  };
  const int stopped = RunUntil(with("--steps 200000"), rows(5), SIGINT);
  ASSERT_TRUE(WIFEXITED(stopped));
  EXPECT_EQ(WEXITSTATUS(stopped), 130);
  const json first = Json("out/run.json");
  const std::string solid = core::ReadFile(Path("out/apple/asset.json"));
  const auto made = fs::last_write_time(Path("out/apple/asset.json"));

  const int killed = RunUntil(with("--steps 200000 --resume"), rows(32), SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(killed));
  fs::create_directories(Path("out/.apple.part-1-0/half"));  // left by a killed reconstruction

  // 40 updates of 2 environments and 64 decisions.
  const Outcome ended = RunProgram(with("--steps 5120 --resume"));
  ASSERT_EQ(ended.code, 0) << ended.text;
  EXPECT_FALSE(fs::exists(Path("out/.apple.part-1-0")));
  const std::vector<std::string> log = Lines(table);
  ASSERT_EQ(log.size(), 41u);
  for (size_t i = 1; i < log.size(); ++i) {
    EXPECT_EQ(log[i].substr(0, log[i].find(',')), std::to_string(i));
  }
  EXPECT_EQ(fs::last_write_time(Path("out/apple/asset.json")), made);
  EXPECT_EQ(core::ReadFile(Path("out/apple/asset.json")), solid);
  const json last = Json("out/run.json");
  ASSERT_EQ(last["stages"].size(), kStages.size());
  for (size_t i = 0; i < kStages.size(); ++i) {
    EXPECT_EQ(last["stages"][i]["name"], kStages[i]);
    EXPECT_EQ(last["stages"][i]["done"], true);
    if (i < 4) {
      EXPECT_EQ(last["stages"][i], first["stages"][i]);
    }
  }
  // The total training time includes that of the killed run.
  const json report = Json("out/report.json");
  EXPECT_GE(report["stages"][4]["seconds"].get<double>(),
            report["training"]["subtasks"][0]["seconds"].get<double>() - 1e-6);
}

TEST_F(RunCommand, BadInputIsRefusedBeforeAnythingIsWritten) {
  ExpectRefused(Arguments(Path("none.png"), "apple", ""), "no such file");
  core::WriteFile(Path("text.png"), "no picture");
  ExpectRefused(Arguments(Path("text.png"), "apple", ""), "not a readable image");
  ExpectRefused(Arguments(Photo("apple.jpg"), "qwertyuiop", ""), "qwertyuiop");
  EXPECT_FALSE(fs::exists(Path("out")));
  fs::create_directories(Path("out"));
  core::WriteFile(Path("out/thesis.txt"), "mine");
  for (const char* flag : {"", "--resume", "--force"}) {
    ExpectRefused(Arguments(Photo("apple.jpg"), "apple", flag), "not a run");
  }
  EXPECT_EQ(core::ReadFile(Path("out/thesis.txt")), "mine");
}

TEST_F(RunCommand, WhatCannotBeTrainedIsRefusedBeforeTraining) {
  // At a height of 20 cm it is about 18 cm wide.
  const std::string wide = "--height 0.2 --resume";
  ExpectRefused(Arguments(Photo("apple.jpg"), "apple", wide), "gripper opens 8.0 cm");
  const std::string text = RunProgram(Arguments(Photo("apple.jpg"), "apple", wide)).text;
  std::smatch remedy;
  ASSERT_TRUE(std::regex_search(text, remedy, std::regex("--force (--height [0-9.]+)"))) << text;
  EXPECT_FALSE(fs::exists(Path("out/skill")));

  // An asset that contradicts its asset.json fails its check, and is kept for inspection.
  json record = Json("out/run.json");
  for (json& stage : record["stages"]) stage["done"] = stage["name"] == "lift";
  core::WriteFile(Path("out/run.json"), record.dump());
  const std::string urdf = core::ReadFile(Path("out/apple/apple.urdf"));
  core::WriteFile(
      Path("out/apple/apple.urdf"),
      std::regex_replace(urdf, std::regex("mass value=\"[^\"]*\""), "mass value=\"9\""));
  ExpectRefused(Arguments(Photo("apple.jpg"), "apple", wide), "loads-urdfdom");
  EXPECT_TRUE(fs::exists(Path("out/apple/preview.png")));

  // At the height that the error message suggests, it can be picked up.
  const std::string lower = remedy[1].str() + " --task fly_apple ";
  ExpectRefused(Arguments(Photo("apple.jpg"), "apple", lower + "--force"), "pick_up_apple");
  ExpectRefused(Arguments(Photo("apple.jpg"), "apple", lower + "--resume"),
                "put_apple_into_drawer_unit_1_and_close_it");
  EXPECT_FALSE(fs::exists(Path("out/skill")));
}

}  // namespace
}  // namespace simwright
