#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace simwright {

struct Outcome {
  int code = -1;
  std::string text;  // stdout, and stderr unless it went elsewhere
};

// Runs a command in a shell.
inline Outcome RunShell(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  size_t count;
  while ((count = fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    outcome.text.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return outcome;
}

// The built program, with these arguments, as a shell runs it. `errors_to` is where the shell
// redirects stderr: "&1" beside stdout, "/dev/null" nowhere.
inline Outcome RunProgram(const std::string& arguments, const std::string& errors_to = "&1") {
  return RunShell(std::string(SIMWRIGHT_PROGRAM) + " " + arguments + " 2>" + errors_to);
}

}  // namespace simwright
