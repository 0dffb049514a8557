#include "workflows/generator/generator_command.h"

#include <cstdio>
#include <filesystem>

#include "core/error.h"
#include "core/files.h"
#include "core/log.h"
#include "llm/redaction.h"
#include "workflows/generator/child_process.h"
#include "workflows/generator/generator_answer.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr const char* kWhere = "--generator-command";
constexpr const char* kExample = "for example --generator-command 'my_model {in} {out}'";

// Splits a command by blanks and quotes.
std::vector<std::string> SplitCommand(const std::string& command) {
  std::vector<std::string> words;
  std::string word;
  bool begun = false;
  char quote = 0;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    if (quote != 0 && c == quote) {
      quote = 0;
    } else if (quote == '\'') {
      word += c;
    } else if (c == '\\' && i + 1 < command.size()) {
      word += command[++i];
      begun = true;
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
      begun = true;
    } else if (quote == 0 && (c == ' ' || c == '\t' || c == '\n')) {
      if (begun) words.push_back(word);
      word.clear();
      begun = false;
    } else {
      word += c;
      begun = true;
    }
  }
  if (quote != 0) throw core::Error("has an open quote", kWhere, kExample);
  if (begun) words.push_back(word);
  return words;
}

// Replaces `name` in `text`, and returns true if it occurred.
bool Replace(const std::string& name, const std::string& value, std::string* text) {
  bool found = false;
  for (std::size_t at = text->find(name); at != std::string::npos;
       at = text->find(name, at + value.size())) {
    text->replace(at, name.size(), value);
    found = true;
  }
  return found;
}

// Returns the last `count` lines that are not empty, on one line.
std::string LastLines(const std::string& text, int count) {
  std::vector<std::string> lines;
  std::size_t end = text.size();
  while (end > 0 && static_cast<int>(lines.size()) < count) {
    const std::size_t before = text.rfind('\n', end - 1);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    const std::string line = text.substr(first, end - first);
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
    end = first == 0 ? 0 : before;
  }
  std::string joined;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    joined += (joined.empty() ? "" : " | ") + *line;
  }
  return llm::Shortened(joined, 400);
}

[[noreturn]] void Fail(const std::string& sentence, const std::string& program,
                       const ChildOutcome& outcome, const std::string& remedy = "") {
  const std::string lines = LastLines(outcome.last_error_lines, 3);
  throw core::Error(sentence + (lines.empty() ? "" : "; the end of its stderr: " + lines), program,
                    remedy);
}

void RequireSuccess(const ChildOutcome& outcome, const std::string& program, double timeout) {
  if (outcome.timed_out) {
    char text[80];
    std::snprintf(text, sizeof(text), "the program was stopped after %.3g s", timeout);
    Fail(text, program, outcome, "allow more time with --generator-timeout");
  }
  if (outcome.signal != 0) {
    Fail("the program was ended by signal " + std::to_string(outcome.signal), program, outcome);
  }
  if (outcome.exit_code != 0) {
    Fail("the program ended with exit code " + std::to_string(outcome.exit_code), program, outcome);
  }
}

}  // namespace

std::vector<std::string> GeneratorArguments(const std::string& command, const std::string& in,
                                            const std::string& out) {
  std::vector<std::string> arguments = SplitCommand(command);
  if (arguments.empty()) throw core::Error("is empty", kWhere, kExample);
  bool reads = false, writes = false;
  for (std::string& argument : arguments) {
    reads = Replace("{in}", in, &argument) || reads;
    writes = Replace("{out}", out, &argument) || writes;
  }
  if (!reads || !writes) {
    throw core::Error(std::string("has no ") + (reads ? "{out}" : "{in}"), kWhere, kExample);
  }
  return arguments;
}

GeneratedMesh RunGeneratorCommand(std::string_view png, const GeneratorOptions& options,
                                  core::Progress* progress,
                                  const std::function<bool()>& cancelled) {
  const core::TemporaryFolder folder;
  const fs::path in = folder.path() / "photo.png", out = folder.path() / "generated.glb";
  core::WriteFile(in, png);
  const std::vector<std::string> arguments =
      GeneratorArguments(options.command, in.string(), out.string());
  const std::string program = fs::path(arguments[0]).filename().string();
  progress->Stage("generator " + program);
  core::Log(core::LogLevel::kInfo, "generator", "running ", program);
  const ChildOutcome outcome = RunChild(arguments, options.timeout, cancelled);
  RequireSuccess(outcome, program, options.timeout);
  std::error_code code;
  const std::uintmax_t size = fs::file_size(out, code);
  if (code || size == 0) {
    Fail(code ? "the program ended well but wrote no file to {out}"
              : "the program ended well but wrote an empty file to {out}",
         program, outcome, "it must write the mesh to the path that {out} stands for");
  }
  if (size > options.max_answer_bytes) {
    Fail("the mesh is larger than " + std::to_string(options.max_answer_bytes >> 20) + " MiB",
         program, outcome, "have the program simplify the mesh and its textures");
  }
  GeneratedMesh mesh;
  mesh.bytes = core::ReadFile(out);
  mesh.extension = MeshExtensionOf(mesh.bytes);
  mesh.generator = program;
  if (mesh.extension.empty()) {
    Fail("the file that the program wrote is " + DescribeContent(mesh.bytes), program, outcome,
         "it must write a GLB, OBJ or PLY");
  }
  progress->Finish();
  return mesh;
}

}  // namespace simwright::workflows
