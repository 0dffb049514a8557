#pragma once

#include <atomic>
#include <csignal>
#include <type_traits>

#include <nanobind/nanobind.h>

#include "core/progress.h"

namespace simwright::python {

namespace nb = nanobind;

// While this object lives, Ctrl-C asks running work to stop (core::RequestCancel) and then reaches
// Python's own handler. Calls of several threads stop together. Nothing changes where SIGINT is
// ignored.
class InterruptScope {
 public:
  InterruptScope();
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
};

// Returns the listener that calls `report(name, detail, done, total, elapsed)` with the GIL held;
// a name of "" ends a stage. An exception of `report` is printed, not thrown. `report` must outlive
// the listener.
core::ProgressListener ListenerOf(nb::handle report);

// Runs work(core::Progress*) without the GIL. `report` is None (no progress) or a function for
// ListenerOf. Ctrl-C ends the work with core::Cancelled, which Python sees as KeyboardInterrupt.
template <typename Work>
auto RunLong(const nb::object& report, const Work& work) {
  const InterruptScope scope;
  const core::ProgressListener listener =
      report.is_none() ? core::ProgressListener() : ListenerOf(report);
  const nb::gil_scoped_release released;
  const auto run = [&] {
    if (!listener) {
      core::Progress silent;
      return work(&silent);
    }
    core::Progress progress(listener);
    return work(&progress);
  };
  auto result = run();
  core::CheckCancelled();  // work that reports what it did not do ends normally
  return result;
}

// Lets one thread at a time use an object whose calls release the GIL: the constructor throws
// core::Error where another thread is in a call of the same object.
class ExclusiveUse {
 public:
  ExclusiveUse(std::atomic_flag* used, const char* what);
  ~ExclusiveUse() { used_->clear(); }
  ExclusiveUse(const ExclusiveUse&) = delete;
  ExclusiveUse& operator=(const ExclusiveUse&) = delete;

 private:
  std::atomic_flag* used_;
};

// Makes Python raise simwright.Error for core::Error and KeyboardInterrupt for core::Cancelled, and
// adds the exceptions to `module`.
void BindErrors(nb::module_& module);

}  // namespace simwright::python
