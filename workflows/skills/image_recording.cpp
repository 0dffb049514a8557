#include "workflows/skills/image_recording.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "core/progress.h"
#include "workflows/generator/child_process.h"
#include "workflows/skills/skill_suite.h"
#include "workflows/tasks/long_tasks.h"

namespace simwright::workflows {
namespace {

constexpr const char* kThisVersion = SIMWRIGHT_VERSION;
constexpr double kImportSeconds = 60.0;
// Exit codes of the check of the package.
constexpr int kNoPackage = 3, kOtherVersion = 4;

std::string CheckOfPackage() {
  return "import sys, importlib.util as u\n"
         "if u.find_spec('simwright') is None: sys.exit(" +
         std::to_string(kNoPackage) +
         ")\n"
         "import simwright\n"
         "sys.stderr.write(simwright.__version__)\n"
         "sys.exit(0 if simwright.__version__ == '" +
         kThisVersion + "' else " + std::to_string(kOtherVersion) + ")\n";
}

std::string LastLine(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

// True for a skill of the suite, false for a long task. Throws core::Error for other names.
bool HasShippedPolicy(const std::string& skill) {
  std::string names;
  for (const SuiteCell& cell : SkillSuite()) {
    if (cell.name == skill) return true;
    names += cell.name + ", ";
  }
  for (const LongTask& task : LongTasks()) {
    if (task.name == skill) return false;
    names += task.name + ", ";
  }
  names.resize(names.size() - 2);
  throw core::Error("there is no skill '" + skill + "'", "", "known ones are " + names);
}

}  // namespace

std::string PythonWithPackage() {
  const char* told = std::getenv("SIMWRIGHT_PYTHON");
  const std::string python = told != nullptr && *told != '\0' ? told : "python3";
  const std::string help =
      "install it with `pip install '.[lerobot,mcap,robomimic]'` in the source folder, or set "
      "SIMWRIGHT_PYTHON to a Python that has it";
  ChildOutcome outcome;
  try {
    outcome = RunChild({python, "-c", CheckOfPackage()}, kImportSeconds, core::CancelRequested);
  } catch (const core::Error&) {
    throw core::Error("there is no such Python", python, help);
  }
  if (outcome.exit_code == 0) return python;
  if (outcome.exit_code == kNoPackage) {
    throw core::Error("has no package simwright, which records images", python, help);
  }
  if (outcome.exit_code == kOtherVersion) {
    throw core::Error("has version " + LastLine(outcome.last_error_lines) + " of the package",
                      python, std::string("this program is version ") + kThisVersion + "; " + help);
  }
  throw core::Error("cannot import the package simwright: " + LastLine(outcome.last_error_lines),
                    python, help);
}

std::vector<std::string> RecordingCommand(const std::string& python,
                                          const ImageRecordingRequest& request) {
  std::vector<std::string> command = {python, "-m", "simwright.demonstrations"};
  const auto add = [&command](const std::string& option, const std::string& value) {
    command.push_back(option);
    command.push_back(value);
  };
  request.skill.empty() ? add("--run", request.run.string()) : add("--skill", request.skill);
  add("--format", request.format);
  add("--output", request.output.string());
  add("--episodes", std::to_string(request.episodes));
  add("--cameras", request.cameras);
  add("--image-size", std::to_string(request.image_size));
  add("--look", request.look);
  add("--keep", request.keep);
  add("--seed", std::to_string(request.seed));
  if (request.threads > 0) add("--threads", std::to_string(request.threads));
  std::string policy = request.policy;
  if (!request.skill.empty() && HasShippedPolicy(request.skill) && policy.empty()) {
    policy = "shipped";
  }
  if (!policy.empty()) add("--policy", policy);
  if (request.quiet) command.push_back("--quiet");
  if (request.json) command.push_back("--json");
  return command;
}

void RecordWithPython(const ImageRecordingRequest& request) {
  const std::vector<std::string> command = RecordingCommand(PythonWithPackage(), request);
  std::vector<char*> arguments;
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  execvp(arguments.front(), arguments.data());
  throw core::Error(std::string("cannot be started: ") + std::strerror(errno), command.front());
}

}  // namespace simwright::workflows
