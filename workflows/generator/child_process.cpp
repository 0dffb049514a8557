#include "workflows/generator/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "core/error.h"

extern char** environ;

namespace simwright::workflows {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr int kPollMilliseconds = 100;
constexpr double kGracePeriod = 2.0;  // s between SIGTERM and SIGKILL
constexpr std::size_t kMostErrorBytes = 2000;

double SecondsSince(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

// The reading end of a pipe and its writing end.
struct Pipe {
  std::array<int, 2> ends = {-1, -1};
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw core::Error(std::string("cannot create a pipe: ") + std::strerror(errno));
    }
  }
  ~Pipe() {
    for (const int end : ends) {
      if (end >= 0) close(end);
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void CloseWriter() {
    close(ends[1]);
    ends[1] = -1;
  }
};

pid_t Spawn(const std::vector<std::string>& arguments, int error_pipe) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, error_pipe, STDERR_FILENO);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t pid = -1;
  const int code = posix_spawnp(&pid, pointers[0], &actions, &attributes, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (code != 0) {
    throw core::Error(std::string("cannot be started: ") + std::strerror(code), arguments[0],
                      "check its name and that it may be executed");
  }
  return pid;
}

// Appends what the pipe holds, waiting for at most a poll interval, and keeps the last bytes.
// Returns false once the pipe is closed.
bool ReadErrors(int pipe, std::string* errors) {
  pollfd waiting = {pipe, POLLIN, 0};
  if (poll(&waiting, 1, kPollMilliseconds) <= 0) return true;
  std::array<char, 4096> buffer;
  const ssize_t count = read(pipe, buffer.data(), buffer.size());
  if (count <= 0) return count < 0 && errno == EINTR;
  errors->append(buffer.data(), static_cast<std::size_t>(count));
  if (errors->size() > 2 * kMostErrorBytes) {
    errors->erase(0, errors->size() - kMostErrorBytes);
  }
  return true;
}

bool HasEnded(pid_t pid, int* status) {
  return waitpid(pid, status, WNOHANG) == pid;
}

// Ends the process group and waits for the program itself.
void EndGroup(pid_t pid, int* status) {
  kill(-pid, SIGTERM);
  const auto start = SteadyClock::now();
  while (SecondsSince(start) < kGracePeriod) {
    if (HasEnded(pid, status)) {
      kill(-pid, SIGKILL);  // its children
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  kill(-pid, SIGKILL);
  waitpid(pid, status, 0);
}

}  // namespace

ChildOutcome RunChild(const std::vector<std::string>& arguments, double timeout,
                      const std::function<bool()>& cancelled) {
  Pipe errors;
  const pid_t pid = Spawn(arguments, errors.ends[1]);
  errors.CloseWriter();
  ChildOutcome outcome;
  const auto start = SteadyClock::now();
  int status = 0;
  bool open = true;
  while (!HasEnded(pid, &status)) {
    const bool stopped = cancelled();
    outcome.timed_out = SecondsSince(start) > timeout;
    if (stopped || outcome.timed_out) {
      EndGroup(pid, &status);
      if (stopped) throw core::Cancelled();
      break;
    }
    if (open) {
      open = ReadErrors(errors.ends[0], &outcome.last_error_lines);
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  // A child of the program may hold the pipe open: only its present content is read.
  for (pollfd rest = {errors.ends[0], POLLIN, 0}; open && poll(&rest, 1, 0) > 0;) {
    open = ReadErrors(errors.ends[0], &outcome.last_error_lines);
  }
  if (outcome.last_error_lines.size() > kMostErrorBytes) {
    outcome.last_error_lines.erase(0, outcome.last_error_lines.size() - kMostErrorBytes);
  }
  if (WIFEXITED(status) && !outcome.timed_out) outcome.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  return outcome;
}

}  // namespace simwright::workflows
