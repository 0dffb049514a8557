#pragma once

#include <functional>
#include <string>
#include <vector>

namespace simwright::workflows {

// The end of a program.
struct ChildOutcome {
  int exit_code = -1;            // -1 unless it ended by itself
  int signal = 0;                // that killed it; 0: none
  bool timed_out = false;        // it was stopped after the timeout
  std::string last_error_lines;  // the last 2000 bytes at most of its stderr
};

// Runs the program `arguments[0]`, searched for in PATH, without a shell. Its stdin is empty, its
// stdout is discarded and its stderr is kept in part. It runs in a process group of its own, which
// is ended, also with its children, after `timeout` seconds or as soon as `cancelled` returns true
// (polled ten times a second); then throws core::Cancelled. Throws core::Error if the program
// cannot be started.
ChildOutcome RunChild(const std::vector<std::string>& arguments, double timeout,
                      const std::function<bool()>& cancelled);

}  // namespace simwright::workflows
