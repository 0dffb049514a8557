#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace simwright {

struct Outcome {
  int code = -1;
  std::string text;  // stdout and stderr
};

// The built program, with these arguments, as a shell runs it.
inline Outcome RunProgram(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen((std::string(SIMWRIGHT_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
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

}  // namespace simwright
