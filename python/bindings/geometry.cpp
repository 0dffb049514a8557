#include <string>
#include <utility>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "geometry/closed_surface.h"
#include "geometry/convex_decomposition.h"
#include "geometry/mass_properties.h"
#include "geometry/solid.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;

nb::tuple MakeSolid(const core::TriangleMesh& mesh, int face_budget, const nb::object& report) {
  geometry::SolidOptions options;
  options.face_budget = face_budget;
  geometry::Solid solid = RunLong(
      report, [&](core::Progress* /*progress*/) { return geometry::MakeSolid(mesh, options); });
  nb::dict facts;
  facts["method"] = geometry::Name(solid.method);
  facts["sheet_thickness"] = solid.sheet_thickness;
  facts["findings"] = solid.findings;
  return nb::make_tuple(std::move(solid.mesh), facts);
}

// Throws core::Error unless the surface is closed.
void RequireClosed(const core::TriangleMesh& mesh, const char* what) {
  if (geometry::IsClosed(mesh)) return;
  throw core::Error("is not closed and oriented", what, "close it with geometry.make_solid");
}

nb::tuple Decompose(const core::TriangleMesh& solid, const geometry::DecompositionOptions& options,
                    const nb::object& report) {
  RequireClosed(solid, "solid");
  geometry::ConvexDecomposition parts = RunLong(
      report, [&](core::Progress* /*progress*/) { return geometry::Decompose(solid, options); });
  nb::dict facts;
  facts["concavity"] = parts.concavity;
  facts["deviation"] = parts.deviation;
  facts["coverage"] = parts.coverage;
  return nb::make_tuple(geometry::Hulls(parts), facts);
}

}  // namespace

void BindGeometry(nb::module_& module) {
  using geometry::MassProperties;
  nb::class_<MassProperties>(module, "MassProperties",
                             "Volume, mass, centre and inertia. Constant.")
      .def_ro("volume", &MassProperties::volume, "m^3, of the material")
      .def_ro("mass", &MassProperties::mass, "kg")
      .def_ro("center_of_mass", &MassProperties::center_of_mass, "(3) m, in the mesh's frame")
      .def_ro("inertia", &MassProperties::inertia, "(3, 3) kg m^2, about the centre of mass");
  module.def(
      "solid_mass_properties",
      [](const core::TriangleMesh& mesh, double density) {
        RequireClosed(mesh, "mesh");
        return geometry::SolidMassProperties(mesh, density);
      },
      "mesh"_a, "density"_a, nb::call_guard<nb::gil_scoped_release>());
  module.def(
      "hollow_mass_properties",
      [](const core::TriangleMesh& mesh, double wall_thickness, double density) {
        RequireClosed(mesh, "mesh");
        return geometry::HollowMassProperties(mesh, wall_thickness, density);
      },
      "mesh"_a, "wall_thickness"_a, "density"_a, nb::call_guard<nb::gil_scoped_release>());
  module.def("shell_mass_properties", &geometry::ShellMassProperties, "mesh"_a, "wall_thickness"_a,
             "density"_a, nb::call_guard<nb::gil_scoped_release>());
  module.def("make_solid", &MakeSolid, "mesh"_a, "face_budget"_a, "report"_a = nb::none());
  module.def(
      "decompose",
      [](const core::TriangleMesh& solid, double threshold, int max_parts, int max_vertices,
         int max_faces, double tolerance, std::uint64_t seed, const nb::object& report) {
        geometry::DecompositionOptions options;
        options.threshold = threshold;
        options.max_parts = max_parts;
        options.max_hull_vertices = max_vertices;
        options.max_hull_faces = max_faces;
        options.tolerance = tolerance;
        options.seed = seed;
        return Decompose(solid, options, report);
      },
      "solid"_a, "threshold"_a, "max_parts"_a, "max_vertices"_a, "max_faces"_a, "tolerance"_a,
      "seed"_a, "report"_a = nb::none());
}

}  // namespace simwright::python
