// Generators that are programs.
#include "workflows/generator/generator_command.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "core/error.h"
#include "core/files.h"

#include "tests/workflows/generator_server.h"  // last: see there

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

std::vector<std::string> SplitGenerator(const std::string& command) {
  return GeneratorArguments(command, "/in dir/p.png", "/out/g.glb");
}

// A program of these shell lines: $1 is {in}, $2 is {out}.
class Script {
 public:
  explicit Script(const std::string& lines) {
    core::WriteFile(path(), "#!/bin/sh\n" + lines);
    fs::permissions(path(), fs::perms::owner_all);
  }
  fs::path path() const { return folder_.path() / "my model.sh"; }
  fs::path folder() const { return folder_.path(); }
  GeneratorOptions Options() const {
    GeneratorOptions options;
    options.command = "'" + path().string() + "' {in} {out}";
    options.timeout = 60.0;
    return options;
  }

 private:
  core::TemporaryFolder folder_;
};

GeneratedMesh RunGenerator(
    const GeneratorOptions& options,
    const std::function<bool()>& cancelled = [] { return false; }) {
  core::Progress silent;
  return RunGeneratorCommand("photo bytes", options, &silent, cancelled);
}

std::string CommandFailure(const GeneratorOptions& options) {
  try {
    RunGenerator(options);
  } catch (const core::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "no failure";
}

TEST(GeneratorCommand, SplitsArgumentsWithoutAShell) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(SplitGenerator("prog {in} {out}"), (Words{"prog", "/in dir/p.png", "/out/g.glb"}));
  EXPECT_EQ(SplitGenerator("  a  'b c' \"d \\\" e\" f\\ g -i={in} '{out}'  "),
            (Words{"a", "b c", "d \" e", "f g", "-i=/in dir/p.png", "/out/g.glb"}));
  EXPECT_EQ(SplitGenerator("p '' $HOME;rm `x` {in} {out}"),
            (Words{"p", "", "$HOME;rm", "`x`", "/in dir/p.png", "/out/g.glb"}));
  EXPECT_EQ(SplitGenerator("p 'it'\\''s' {in}{out}"),
            (Words{"p", "it's", "/in dir/p.png/out/g.glb"}));
  for (const char* wrong : {"", "  ", "prog", "prog {in}", "prog {out}", "prog '{in} {out}"}) {
    EXPECT_THROW(SplitGenerator(wrong), core::Error) << wrong;
  }
}

TEST(GeneratorCommand, TakesTheMeshThatTheProgramWrites) {
  const core::TemporaryFolder folder;
  const std::string glb = BoxGlb(1, 2, 3);
  core::WriteFile(folder.path() / "box.glb", glb);
  const Script script("cp \"$1\" " + (folder.path() / "seen.png").string() + "\ncp " +
                      (folder.path() / "box.glb").string() + " \"$2\"\necho fine >&2\n");
  const GeneratedMesh mesh = RunGenerator(script.Options());
  EXPECT_EQ(mesh.bytes, glb);
  EXPECT_EQ(mesh.extension, ".glb");
  EXPECT_EQ(mesh.generator, "my model.sh");
  EXPECT_EQ(core::ReadFile(folder.path() / "seen.png"), "photo bytes");
}

TEST(GeneratorCommand, ReportsFailuresWithTheEndOfStderr) {
  const std::string failed = CommandFailure(
      Script("echo one >&2; echo two >&2; echo three >&2; echo CUDA out of memory >&2; exit 3\n")
          .Options());
  ExpectIn("my model.sh: the program ended with exit code 3", failed);
  ExpectIn("two | three | CUDA out of memory", failed);
  EXPECT_EQ(failed.find("one"), std::string::npos);
  ExpectIn("wrote no file to {out}", CommandFailure(Script("exit 0\n").Options()));
  ExpectIn("wrote an empty file to {out}", CommandFailure(Script("> \"$2\"\n").Options()));
  ExpectIn("no mesh but \"hello\"", CommandFailure(Script("echo hello > \"$2\"\n").Options()));
  ExpectIn("ended by signal 9", CommandFailure(Script("kill -9 $$\n").Options()));
  GeneratorOptions missing;
  missing.command = "/no/such/program {in} {out}";
  ExpectIn("/no/such/program: cannot be started", CommandFailure(missing));
  GeneratorOptions large = Script("").Options();
  const Script writes("head -c 2000000 /dev/zero > \"$2\"\n");
  large = writes.Options();
  large.max_answer_bytes = 1 << 20;
  ExpectIn("larger than 1 MiB", CommandFailure(large));
}

// A megabyte of stderr neither blocks the program nor is kept.
TEST(GeneratorCommand, SurvivesMuchOutput) {
  const Script script(
      "i=0; while [ $i -lt 20000 ]; do echo 'a line of fifty characters, again "
      "and again and on' >&2; i=$((i+1)); done; echo last >&2; exit 1\n");
  const std::string message = CommandFailure(script.Options());
  ExpectIn("| last", message);
  EXPECT_LT(message.size(), 700u);
}

TEST(GeneratorCommand, StopsTheProgramAndItsChildrenAtTheTimeout) {
  const core::TemporaryFolder folder;
  const std::string alive = (folder.path() / "alive").string();
  const Script script("echo begun >&2; (sleep 30; touch " + alive + ") & wait\n");
  GeneratorOptions options = script.Options();
  options.timeout = 0.5;
  const auto start = std::chrono::steady_clock::now();
  const std::string message = CommandFailure(options);
  ExpectIn("was stopped after 0.5 s", message);
  ExpectIn("begun", message);
  ExpectIn("--generator-timeout", message);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_THROW(RunGenerator(script.Options(), [] { return true; }), core::Cancelled);
}

}  // namespace
}  // namespace simwright::workflows
