#include <nanobind/nanobind.h>

#include "core/parallel.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"

// The compiled half of the package: thin functions on plain values. python/simwright/ gives them
// their public names.
NB_MODULE(_core, module) {
  namespace nb = nanobind;
  using nb::literals::operator""_a;
  using namespace simwright;  // NOLINT(google-build-using-namespace)
  // torch keeps what its graphs hold until the process ends: no leak of ours.
  nb::set_leak_warnings(false);
  module.attr("__version__") = SIMWRIGHT_VERSION;
  python::BindErrors(module);
  module.def("set_threads", &core::SetThreadCount, "count"_a,
             "Sets the number of threads for long work; 0: all that this process may use.");
  module.def("threads", &core::ThreadCount, "Returns the number of threads for long work.");
  python::BindMeshes(module);
  python::BindAssets(module);
  python::BindGeometry(module);
  python::BindRendering(module);
  python::BindPhysics(module);
  python::BindRewards(module);
  python::BindTasks(module);
  python::BindSkills(module);
  python::BindCameras(module);
  python::BindEnvironments(module);
  python::BindScenes(module);
}
