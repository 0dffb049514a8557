#include "python/bindings/calls.h"

#include <mutex>

#include <nanobind/stl/string.h>

#include "core/error.h"

namespace simwright::python {
namespace {

// Calls of several threads share the handler, which the first installs and the last removes.
std::mutex scope_mutex;
int scopes = 0;
bool installed = false;
struct sigaction python_action;  // the handler while a scope lives

void OnSignal(int number) {
  core::RequestCancel();
  if (python_action.sa_handler != SIG_DFL && python_action.sa_handler != SIG_IGN) {
    python_action.sa_handler(number);
  }
}

// The class of the exception, for its whole life.
PyObject* error_type = nullptr;

void RaiseError(const core::Error& error) {
  PyObject* instance = PyObject_CallFunction(error_type, "s", error.what());
  if (instance == nullptr) return;
  PyObject* where = PyUnicode_FromString(error.where().c_str());
  if (where != nullptr) {
    PyObject_SetAttrString(instance, "where", where);
    Py_DECREF(where);
  }
  PyErr_SetObject(error_type, instance);
  Py_DECREF(instance);
}

void RaiseInterrupt() {
  {
    // A call of another thread has yet to see the request.
    const std::lock_guard lock(scope_mutex);
    if (scopes == 0) core::ClearCancelRequest();
  }
  // Python's handler ran too: it raises KeyboardInterrupt here in the main thread.
  if (PyErr_CheckSignals() == 0) PyErr_SetNone(PyExc_KeyboardInterrupt);
}

void Translate(const std::exception_ptr& pointer, void*) {
  try {
    std::rethrow_exception(pointer);
  } catch (const core::Error& error) {
    RaiseError(error);
  } catch (const core::Cancelled&) {
    RaiseInterrupt();
  }
}

}  // namespace

InterruptScope::InterruptScope() {
  const std::lock_guard lock(scope_mutex);
  if (scopes++ > 0) return;
  core::ClearCancelRequest();
  struct sigaction action = {};
  sigaction(SIGINT, nullptr, &python_action);
  if ((python_action.sa_flags & SA_SIGINFO) != 0 || python_action.sa_handler == SIG_IGN) return;
  action.sa_handler = OnSignal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  installed = true;
}

InterruptScope::~InterruptScope() {
  const std::lock_guard lock(scope_mutex);
  if (--scopes > 0 || !installed) return;
  sigaction(SIGINT, &python_action, nullptr);
  installed = false;
}

ExclusiveUse::ExclusiveUse(std::atomic_flag* used, const char* what) : used_(used) {
  if (used->test_and_set()) {
    throw core::Error("is in use by another thread", what, "make one for each thread");
  }
}

core::ProgressListener ListenerOf(nb::handle report) {
  return [report](const core::ProgressState& state) {
    const nb::gil_scoped_acquire acquired;
    try {
      report(state.name, state.detail, state.done, state.total, state.elapsed);
    } catch (nb::python_error& error) {
      // The call itself raises it, once the work has stopped.
      if (error.matches(PyExc_KeyboardInterrupt)) {
        core::RequestCancel();
        return;
      }
      error.discard_as_unraisable(report);
    }
  };
}

void BindErrors(nb::module_& module) {
  error_type =
      PyErr_NewExceptionWithDoc("simwright.Error",
                                "What went wrong, where, and what to do about it, in one line.\n\n"
                                "Attributes:\n    where (str): the file, the element or the "
                                "argument concerned; may be empty.",
                                PyExc_RuntimeError, nullptr);
  if (error_type == nullptr) throw nb::python_error();
  PyObject_SetAttrString(error_type, "where", nb::str("").ptr());
  module.attr("Error") = nb::handle(error_type);
  nb::register_exception_translator(Translate);
}

}  // namespace simwright::python
