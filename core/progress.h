#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace simwright::core {

// How far a stage has come, as a line says it.
struct ProgressState {
  std::string name;
  std::string detail;       // what it has to say beside its count; may be empty
  int done = 0, total = 0;  // steps; total 0: unknown
  double elapsed = 0.0;     // s
  std::optional<double> most_left;  // s that it takes at most from now on, as with a time limit
};

// "train open_door: 12/488, 46 % succeed, 80 s left". The time left is that of the steps so far, at
// most `most_left`; where neither is known the line says the time so far.
std::string ProgressLine(const ProgressState& state);

// Says how far long work has come. On a terminal one line that is drawn over, with the time left;
// elsewhere a plain line every ten seconds and one at the end of a stage. Writes to stderr; a
// silent one writes nothing.
// Also where long work notices Ctrl-C: every call that advances may throw core::Cancelled.
class Progress {
 public:
  enum class Style { kSilent, kPlain, kTerminal };

  // `plain_interval`: s between two plain lines of a stage.
  explicit Progress(Style style = Style::kSilent, double plain_interval = 10.0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // kTerminal where stderr is one, else kPlain.
  static Style StyleForStderr();

  // Starts a stage of `total` steps (0: unknown). Ends the one before. Throws Cancelled.
  void Stage(const std::string& name, int total = 0);
  // What the stage has to say from now on beside its count, as "46 % succeed", and s that it takes
  // at most from now on (none: unknown). Safe from several threads.
  void Say(const std::string& detail, std::optional<double> most_left = std::nullopt);
  // One step done; safe from several threads. Throws Cancelled.
  void Advance();
  // Ends the last stage.
  void Finish();

 private:
  struct Shared;  // with the thread that draws while no step is done

  Style style_;
  std::unique_ptr<Shared> shared_;  // none where silent
  std::atomic<int> done_{0};
};

// Installs a handler so that Ctrl-C asks running work to stop; a second Ctrl-C kills.
void InstallCancelHandler();
void RequestCancel();
bool CancelRequested();
// Throws core::Cancelled after RequestCancel().
void CheckCancelled();

}  // namespace simwright::core
