// `simwright export` of demonstrations with images: what the Python package is called with. The
// package's own tests are in tests/python.
#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/workflows/program.h"
#include "tests/workflows/scripted_run.h"
#include "workflows/skills/image_recording.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

class ImageExportCommand : public ScriptedRuns {
 protected:
  // Runs the command with a Python that is the shell script `body`.
  Outcome RunWith(const std::string& body, const std::string& arguments) const {
    const std::string python = Path("python");
    std::ofstream(python) << "#!/bin/sh\n" << body;
    fs::permissions(python, fs::perms::owner_all);
    setenv("SIMWRIGHT_PYTHON", python.c_str(), 1);
    const Outcome outcome = RunProgram("export " + arguments);
    unsetenv("SIMWRIGHT_PYTHON");
    return outcome;
  }
  static void ExpectRefused(const Outcome& outcome, int code, const std::string& says) {
    EXPECT_EQ(outcome.code, code) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
  }
  static constexpr const char* kEcho = "[ \"$1\" = -c ] && exit 0\necho \"$@\"\nexit 7\n";
};

TEST_F(ImageExportCommand, PassesTheOptionsAndTheExitCode) {
  const Outcome shipped =
      RunWith(kEcho, "--skill open_drawer --format lerobot --seed 5 --episodes 3 -o drawers");
  EXPECT_EQ(shipped.code, 7);
  EXPECT_EQ(shipped.text,
            "-m simwright.demonstrations --skill open_drawer --format lerobot --output drawers "
            "--episodes 3 --cameras front,wrist --image-size 128 --look none --keep successes "
            "--seed 5 --policy shipped\n");
  const Outcome run =
      RunWith(kEcho,
              "RUN --format robomimic --cameras wrist --image-size 64 --look wide "
              "--keep all --policy expert --episodes 2 --threads 1 --quiet --json -o a.hdf5");
  EXPECT_EQ(
      run.text,
      "-m simwright.demonstrations --run RUN --format robomimic --output a.hdf5 --episodes 2 "
      "--cameras wrist --image-size 64 --look wide --keep all --seed 1 --threads 1 --policy expert "
      "--quiet --json\n");
  // A long task has no trained policy of its own.
  const Outcome chain = RunWith(kEcho, "--skill apple_into_drawer --format mcap -o out");
  EXPECT_EQ(chain.text.find("--policy"), std::string::npos) << chain.text;
}

TEST_F(ImageExportCommand, SaysHowToGetThePackage) {
  const std::string arguments = "--skill open_drawer --format lerobot -o drawers";
  ExpectRefused(RunWith("exit 3\n", arguments), 1, "pip install '.[lerobot,mcap,robomimic]'");
  ExpectRefused(RunWith("printf 0.0.9 >&2\nexit 4\n", arguments), 1, "has version 0.0.9");
  ExpectRefused(RunWith("echo 'Trace' >&2; echo 'ImportError: libX' >&2\nexit 1\n", arguments), 1,
                "cannot import the package simwright: ImportError: libX");
  setenv("SIMWRIGHT_PYTHON", "/nonexistent/python", 1);
  ExpectRefused(RunProgram("export " + arguments), 1, "there is no such Python");
  unsetenv("SIMWRIGHT_PYTHON");
}

TEST_F(ImageExportCommand, RefusesOptionsThatDoNotBelongTogether) {
  ExpectRefused(RunWith(kEcho, "--skill fold_towel --format lerobot -o x"), 1,
                "there is no skill 'fold_towel'");
  ExpectRefused(RunWith(kEcho, "--skill open_drawer --format lerobot --force -o x"), 1, "--force");
  EXPECT_EQ(RunProgram("export RUN --format csv --cameras front -o x.csv").code, 2);
  EXPECT_EQ(RunProgram("export --format lerobot -o x").code, 2);
  // An option is refused where it has no effect.
  for (const char* unused :
       {"RUN --format csv --image-size 64 -o x.csv", "RUN --format ros2 --look wide -o x.yaml",
        "--skill open_drawer --format onnx --keep all -o x.onnx",
        "RUN --format robomimic --policy expert -o x.hdf5",
        "RUN --format lerobot --joint-names fr3 -o x", "RUN --format mcap --pace recorded -o x"}) {
    const Outcome outcome = RunProgram(std::string("export ") + unused);
    EXPECT_EQ(outcome.code, 2) << unused << ": " << outcome.text;
  }
  EXPECT_EQ(RunProgram("export --skill open_drawer --format robomimic -o x.hdf5").code, 2);
}

}  // namespace
}  // namespace simwright::workflows
