#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

#include "core/files.h"
#include "tests/workflows/program.h"

namespace simwright {

// Returns true if there is a folder beside `output` whose name contains its name: the one in which
// a command prepares its output.
inline bool HasStagingFolderOf(const std::filesystem::path& output) {
  for (const auto& entry : std::filesystem::directory_iterator(output.parent_path())) {
    const bool named =
        entry.path().filename().string().find(output.filename().string()) != std::string::npos;
    if (named && std::filesystem::is_directory(entry.path())) return true;
  }
  return false;
}

// The built program at work beside the test. It is killed where the test does not wait for it.
class RunningProgram {
 public:
  // `log`: a file that its output goes to.
  RunningProgram(const std::string& arguments, const std::filesystem::path& log) : log_(log) {
    pid_ = fork();
    if (pid_ != 0) return;
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    const std::string command = "exec " + std::string(SIMWRIGHT_PROGRAM) + " " + arguments;
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  ~RunningProgram() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  pid_t pid() const { return pid_; }

  // Waits until `done`; false where the program has ended before, or after two minutes.
  bool WaitFor(const std::function<bool()>& done) {
    for (int i = 0; i < 2400; ++i) {
      if (done()) return true;
      siginfo_t ended = {};
      waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT);
      if (ended.si_pid == pid_) return done();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }

  // Sends the signal, and waits for the end.
  Outcome EndBy(int signal) {
    kill(pid_, signal);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    outcome.text = core::ReadFile(log_);
    return outcome;
  }

 private:
  std::filesystem::path log_;
  pid_t pid_ = -1;
};

}  // namespace simwright
