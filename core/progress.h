#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace simwright::core {

// The progress of a stage, as a progress line shows it.
struct ProgressState {
  std::string name;
  std::string detail;               // shown beside the count; may be empty
  int done = 0, total = 0;          // steps; total 0: unknown
  double elapsed = 0.0;             // s
  std::optional<double> most_left;  // s, upper bound of the remaining time, e.g. a time limit
};

// Formats a line such as "train open_door: 12/488, 46 % succeed, 80 s left". The remaining time is
// extrapolated from the steps so far and bounded by `most_left`; if neither is known, the line
// shows the elapsed time.
std::string ProgressLine(const ProgressState& state);

// Receives the state of a stage; one whose `name` is empty ends the stage. Called from the working
// thread and from a thread that the Progress owns, one call at a time; must not throw.
using ProgressListener = std::function<void(const ProgressState&)>;

// Reports the progress of long work to stderr. On a terminal it redraws one line with the remaining
// time; elsewhere it prints a plain line every ten seconds and one at the end of a stage. kSilent
// prints nothing, kListener calls a function instead. Long work also notices Ctrl-C here: every
// call that advances may throw core::Cancelled.
class Progress {
 public:
  enum class Style { kSilent, kPlain, kTerminal, kListener };

  // `plain_interval`: seconds between two plain lines of a stage.
  explicit Progress(Style style = Style::kSilent, double plain_interval = 10.0);
  // Passes the state to `listener`, at most once per `interval` seconds, and at the end of a stage.
  explicit Progress(ProgressListener listener, double interval = 0.2);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Returns kTerminal if stderr is a terminal, else kPlain.
  static Style StyleForStderr();

  // Starts a stage of `total` steps (0: unknown) and ends the previous one. Throws Cancelled.
  void Stage(const std::string& name, int total = 0);
  // Sets the detail shown beside the count, such as "46 % succeed", and the upper bound of the
  // remaining time in seconds (none: unknown). Thread-safe.
  void Say(const std::string& detail, std::optional<double> most_left = std::nullopt);
  // Counts one step. Thread-safe. Throws Cancelled.
  void Advance();
  // Ends the last stage.
  void Finish();

 private:
  struct Shared;  // shared with the thread that redraws between steps

  Style style_;
  std::unique_ptr<Shared> shared_;  // null if silent
  std::atomic<int> done_{0};
};

// Installs a handler so that Ctrl-C asks running work to stop; a second Ctrl-C kills.
void InstallCancelHandler();
void RequestCancel();
bool CancelRequested();
// Forgets the request, so that later work runs: for programs that go on after they were stopped.
void ClearCancelRequest();
// Throws core::Cancelled after RequestCancel().
void CheckCancelled();

}  // namespace simwright::core
