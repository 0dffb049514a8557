#pragma once

#include <atomic>
#include <chrono>
#include <string>

namespace simwright::core {

// Says how far long work has come. On a terminal one line that is drawn over, with the time left;
// elsewhere one plain line a stage. Writes to stderr; a silent one writes nothing.
// Also where long work notices Ctrl-C: every call that advances may throw core::Cancelled.
class Progress {
 public:
  enum class Style { kSilent, kPlain, kTerminal };

  explicit Progress(Style style = Style::kSilent) : style_(style) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // kTerminal where stderr is one, else kPlain.
  static Style StyleForStderr();

  // Starts a stage of `total` steps (0: unknown). Ends the one before. Throws Cancelled.
  void Stage(const std::string& name, int total = 0);
  // One step done; safe from several threads. Throws Cancelled.
  void Advance();
  // Ends the last stage.
  void Finish();

 private:
  void Draw(int done);

  Style style_;
  std::string name_;
  int total_ = 0;
  std::atomic<int> done_{0};
  std::atomic<long> last_drawn_ms_{0};
  std::chrono::steady_clock::time_point start_{};
};

// Installs a handler so that Ctrl-C asks running work to stop; a second Ctrl-C kills.
void InstallCancelHandler();
void RequestCancel();
bool CancelRequested();
// Throws core::Cancelled after RequestCancel().
void CheckCancelled();

}  // namespace simwright::core
