// The program's flags: unknown ones are answered with the nearest, help shows every default, --json
// is JSON everywhere, and --config may stand anywhere.
#include <gtest/gtest.h>

#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

void ExpectUsage(const std::string& arguments, const std::string& says) {
  const Outcome outcome = RunProgram(arguments);
  EXPECT_EQ(outcome.code, 2) << outcome.text;
  EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
  EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
}

TEST(Usage, TheNearestIsNamed) {
  ExpectUsage("lfit", "did you mean lift?");
  ExpectUsage("imprt a.obj -o b", "did you mean import?");
  ExpectUsage("scene smaple --type dimsum -o x", "did you mean sample?");
  ExpectUsage("lift a.jpg --categroy mug -o b", "did you mean --category?");
  ExpectUsage("import a.obj -o b --heigth 1", "did you mean --height?");
  ExpectUsage("zorbelflux", "unknown subcommand zorbelflux");
  ExpectUsage("export run --format rso2 -o x", "ros2");
  ExpectUsage("skils", "did you mean skills?");
  ExpectUsage("rollout --skil open_drawer", "did you mean --skill?");
  ExpectUsage("run a.jpg --category mug --lift slow", "fast");
}

const char* const kCommands[] = {"lift",
                                 "import",
                                 "physics",
                                 "check",
                                 "grasps",
                                 "texture",
                                 "library",
                                 "propose",
                                 "prior train",
                                 "tasks",
                                 "reward",
                                 "train",
                                 "rollout",
                                 "skills",
                                 "export",
                                 "replay",
                                 "run",
                                 "view",
                                 "doctor",
                                 "completion",
                                 "version",
                                 "scene generate",
                                 "scene train",
                                 "scene sample",
                                 "scene complete",
                                 "scene rearrange",
                                 "scene certify",
                                 "scene search",
                                 "scene posttrain",
                                 "scene evaluate",
                                 "scene export",
                                 "scene view",
                                 "scene features train"};

TEST(Usage, HelpGivesEveryDefaultAndNamesOfChoices) {
  for (const char* command : kCommands) {
    const Outcome help = RunProgram(std::string(command) + " --help");
    ASSERT_EQ(help.code, 0) << command;
    std::istringstream lines(help.text);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("  --", 0) != 0 && line.rfind("  -", 0) != 0) continue;
      const bool takes = line.find("TEXT") != std::string::npos ||
                         line.find("INT") != std::string::npos ||
                         line.find("FLOAT") != std::string::npos;
      if (!takes) continue;
      line = std::regex_replace(line, std::regex(" in \\[[^\\]]*\\]"), "");  // a range
      EXPECT_TRUE(line.find('[') != std::string::npos || line.find("REQUIRED") != std::string::npos)
          << command << ": " << line;
      EXPECT_EQ(line.find("->"), std::string::npos) << command << ": " << line;
    }
  }
}

TEST(Usage, JsonIsJson) {
  for (const char* command :
       {"version", "doctor", "scene generate --list", "library --list", "skills",
        "physics --category mug", "import none -o x", "check none"}) {
    const Outcome outcome = RunProgram(std::string(command) + " --json", "/dev/null");
    ASSERT_TRUE(nlohmann::json::accept(outcome.text)) << command << ": " << outcome.text;
    EXPECT_TRUE(nlohmann::json::parse(outcome.text)["findings"].is_array()) << command;
  }
  const auto version = nlohmann::json::parse(RunProgram("version --json").text);
  const std::string text = RunProgram("version").text;
  EXPECT_EQ(text.rfind("simwright " + version["version"].get<std::string>() + "\n", 0), 0u) << text;
  EXPECT_EQ(RunProgram("--version").text, text);
  for (const auto& [name, value] : version["built_with"].items()) {
    EXPECT_TRUE(std::regex_search(
        text, std::regex("\n  " + name + " +[^\n]*" + value.get<std::string>().substr(0, 3))))
        << name;
    EXPECT_FALSE(value.get<std::string>().empty()) << name;
  }
}

// A library's own version, as it reports it when it runs, is what the program says.
TEST(Usage, VersionNamesTheLibraries) {
  const auto built = nlohmann::json::parse(RunProgram("version --json").text)["built_with"];
  EXPECT_EQ(built["nlohmann-json"], std::to_string(NLOHMANN_JSON_VERSION_MAJOR) + "." +
                                        std::to_string(NLOHMANN_JSON_VERSION_MINOR) + "." +
                                        std::to_string(NLOHMANN_JSON_VERSION_PATCH));
  const std::string doctor = RunProgram("doctor").text;
  EXPECT_NE(doctor.find("MuJoCo " + built["MuJoCo"].get<std::string>()), std::string::npos)
      << built.dump() << doctor;
  for (const char* name : {"assimp", "Bullet", "Ceres", "CGAL", "Eigen", "Embree", "libtorch",
                           "OpenCV", "urdfdom", "compiler"}) {
    EXPECT_TRUE(built.contains(name)) << name;
  }
}

// Runs the completion as bash does, for the words of `line`, of which the last is being typed.
std::string Completed(const std::string& script, const std::string& line) {
  const std::string command = "bash -c 'source " + script + "; COMP_WORDS=(" + line +
                              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _simwright; "
                              "echo \"${COMPREPLY[@]}\"'";
  return RunShell(command).text;
}

TEST(Usage, BashCompletes) {
  const core::TemporaryFolder folder;
  const std::string script = (folder.path() / "simwright").string();
  core::WriteFile(script, RunProgram("completion --shell bash").text);
  EXPECT_EQ(Completed(script, "simwright lif"), "lift\n");
  EXPECT_EQ(Completed(script, "simwright scene gen"), "generate\n");
  EXPECT_EQ(Completed(script, "simwright import --hei"), "--height\n");
  EXPECT_EQ(Completed(script, "simwright import --report --hei"), "--height\n");
  EXPECT_EQ(Completed(script, "simwright import --up \"\""), "x y z\n");
  EXPECT_EQ(Completed(script, "simwright import " + script.substr(0, script.size() - 2)),
            script + "\n");
  EXPECT_EQ(Completed(script, "simwright scene features --t"), "\n");
  EXPECT_EQ(RunShell("bash -n " + script).code, 0);
  const std::string fish = RunProgram("completion --shell fish").text;
  EXPECT_NE(fish.find("-n '__fish_seen_subcommand_from import' -l up -r -f -a 'x y z'"),
            std::string::npos);
}

TEST(Usage, DoctorNamesWhatItNeeds) {
  const Outcome doctor = RunProgram("doctor");
  EXPECT_EQ(doctor.code, 0) << doctor.text;
  for (const char* word : {"bullet", "MuJoCo ", "urdfdom", "wordnet", "weights"}) {
    EXPECT_NE(doctor.text.find(word), std::string::npos) << word << "\n" << doctor.text;
  }
}

TEST(Usage, TheLogGoesToStderrAtTheStatedLevel) {
  ExpectUsage("physics --category mug --log-level loud", "{trace,debug,info,warn,error,off}");
  ExpectUsage("physics --category mug --seed -1", "whole number of at least 0");
  const core::TemporaryFolder folder;
  const std::string make = "library --kind light_switch --quiet -o ";
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  const std::string silent = RunProgram(make + path("silent")).text;
  EXPECT_EQ(silent.find("[info]"), std::string::npos) << silent;
  const std::string logged = RunProgram(make + path("logged") + " --log-level info").text;
  EXPECT_NE(logged.find("[info] [assets] wrote "), std::string::npos) << logged;
  const std::string results =
      RunProgram(make + path("results") + " --log-level info", "/dev/null").text;
  EXPECT_EQ(results.find("[info]"), std::string::npos) << results;

  setenv("SIMWRIGHT_LOG", "info", 1);
  const std::string variable = RunProgram(make + path("variable")).text;
  EXPECT_NE(variable.find("[info] [assets] wrote "), std::string::npos) << variable;
  const std::string option = RunProgram(make + path("option") + " --log-level off").text;
  EXPECT_EQ(option.find("[info]"), std::string::npos) << option;
  setenv("SIMWRIGHT_LOG", "loud", 1);
  const std::string wrong = RunProgram("version").text;
  EXPECT_NE(wrong.find("[warning] [core] SIMWRIGHT_LOG: loud: is not a log level"),
            std::string::npos)
      << wrong;
  unsetenv("SIMWRIGHT_LOG");
}

class ConfigFile : public ::testing::Test {
 protected:
  std::string Write(const std::string& text) const {
    core::WriteFile(folder_.path() / "flags.toml", text);
    return (folder_.path() / "flags.toml").string();
  }
  const core::TemporaryFolder folder_;
};

TEST_F(ConfigFile, MayStandBeforeAndBehindTheSubcommand) {
  const std::string file = Write("[physics]\ncategory = \"teapot\"\n");
  const std::string before = RunProgram("--config " + file + " physics --quiet").text;
  EXPECT_EQ(before.rfind("teapot ", 0), 0u) << before;
  EXPECT_EQ(RunProgram("physics --quiet --config " + file).text, before);
  EXPECT_EQ(RunProgram("physics --config=" + file + " --quiet").text, before);
  const std::string flag = RunProgram("physics --config " + file + " --category mug --quiet").text;
  EXPECT_EQ(flag.rfind("mug ", 0), 0u) << flag;
}

TEST_F(ConfigFile, TyposAreRefusedWithTheNearest) {
  ExpectUsage("physics --config " + Write("[physics]\ncategroy = \"mug\"\n"),
              "did you mean category?");
  ExpectUsage("physics --category mug --config " + Write("[phsyics]\nseed = 3\n"),
              "did you mean physics?");
  ExpectUsage("physics --category mug --config " + Write("[scene.generate]\ncuont = 3\n"),
              "did you mean count?");
}

}  // namespace
}  // namespace simwright
