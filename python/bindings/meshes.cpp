#include <optional>
#include <string>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "assets/mesh_import.h"
#include "core/error.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
const Eigen::Vector4f kPlain(0.75f, 0.75f, 0.75f, 1.0f);
static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
static_assert(sizeof(Eigen::Vector3i) == 3 * sizeof(std::int32_t));
static_assert(sizeof(Eigen::Vector2f) == 2 * sizeof(float));

void MakeMesh(core::TriangleMesh* self, const PointsArgument& vertices,
              const TrianglesArgument& triangles) {
  core::TriangleMesh mesh;
  mesh.vertices.resize(vertices.shape(0));
  std::copy_n(vertices.data(), 3 * vertices.shape(0), mesh.vertices.data()->data());
  mesh.triangles.resize(triangles.shape(0));
  std::copy_n(triangles.data(), 3 * triangles.shape(0), mesh.triangles.data()->data());
  core::RequireValid(mesh, "mesh");
  new (self) core::TriangleMesh(std::move(mesh));
}

std::string MeshText(const core::TriangleMesh& mesh) {
  return "Mesh(" + std::to_string(mesh.vertices.size()) + " vertices, " +
         std::to_string(mesh.triangles.size()) + " triangles)";
}

void BindTriangleMesh(nb::module_& module) {
  nb::class_<core::TriangleMesh>(
      module, "Mesh",
      "Triangles with shared vertices, in metres; counter-clockwise seen from outside. Constant.")
      .def("__init__", &MakeMesh, "vertices"_a, "triangles"_a,
           "Copies `vertices` (N, 3) float64 and `triangles` (M, 3) int32.\n\n"
           "Raises:\n    Error: for an index out of range or a number that is not finite.")
      .def_prop_ro(
          "vertices",
          [](nb::handle self) {
            const auto& mesh = nb::cast<const core::TriangleMesh&>(self);
            return View3(reinterpret_cast<const double*>(mesh.vertices.data()),
                         mesh.vertices.size(), self);
          },
          "(N, 3) float64, m; a view")
      .def_prop_ro(
          "triangles",
          [](nb::handle self) {
            const auto& mesh = nb::cast<const core::TriangleMesh&>(self);
            return View3(reinterpret_cast<const std::int32_t*>(mesh.triangles.data()),
                         mesh.triangles.size(), self);
          },
          "(M, 3) int32, indices of vertices; a view")
      .def_prop_ro("area", &core::SurfaceArea, "m^2")
      .def_prop_ro(
          "bounds",
          [](const core::TriangleMesh& mesh) {
            const Eigen::AlignedBox3d box = core::Bounds(mesh);
            return Eigen::Matrix<double, 2, 3, Eigen::RowMajor>(
                (Eigen::Matrix<double, 2, 3, Eigen::RowMajor>() << box.min().transpose(),
                 box.max().transpose())
                    .finished());
          },
          "(2, 3) float64, m: the least and the largest coordinates")
      .def("__repr__", &MeshText);
}

nb::list TexturesOf(const core::TexturedMesh& mesh) {
  nb::list textures;
  for (const core::Image& image : mesh.textures) {
    std::vector<std::uint8_t> pixels = image.pixels;
    textures.append(Owned(std::move(pixels),
                          {static_cast<size_t>(image.height), static_cast<size_t>(image.width),
                           static_cast<size_t>(image.channels)}));
  }
  return textures;
}

nb::list MaterialsOf(const core::TexturedMesh& mesh) {
  nb::list materials;
  for (const core::Material& material : mesh.materials) {
    nb::dict dict;
    dict["name"] = material.name;
    dict["base_color"] = material.base_color;
    dict["texture"] = material.texture < 0 ? nb::none() : nb::cast(material.texture);
    materials.append(dict);
  }
  return materials;
}

void BindTexturedMesh(nb::module_& module) {
  nb::class_<core::TexturedMesh>(module, "TexturedMesh", "A mesh with its appearance. Constant.")
      .def(
          "__init__",
          [](core::TexturedMesh* self, const core::TriangleMesh& mesh,
             const std::optional<Eigen::Vector4f>& color) {
            new (self) core::TexturedMesh();
            self->mesh = mesh;
            self->triangle_material.assign(mesh.triangles.size(), 0);
            self->materials.push_back({"plain", color.value_or(kPlain), -1});
          },
          "mesh"_a, "color"_a = nb::none(),
          "A mesh of one colour (4): RGBA in [0, 1], sRGB; None: light grey.")
      .def_prop_ro(
          "mesh",
          [](const core::TexturedMesh& mesh) -> const core::TriangleMesh& { return mesh.mesh; },
          nb::rv_policy::reference_internal)
      .def_prop_ro(
          "corner_uvs",
          [](nb::handle self) {
            const auto& mesh = nb::cast<const core::TexturedMesh&>(self);
            return View(reinterpret_cast<const float*>(mesh.corner_uvs.data()),
                        {mesh.corner_uvs.size(), 2}, self);
          },
          "(3 M, 2) float32, origin at the texture's lower left; (0, 2) without textures; a view")
      .def_prop_ro(
          "triangle_materials",
          [](nb::handle self) {
            const auto& mesh = nb::cast<const core::TexturedMesh&>(self);
            return View(mesh.triangle_material.data(), {mesh.triangle_material.size()}, self);
          },
          "(M) int32, indices of materials; a view")
      .def_prop_ro("materials", &MaterialsOf,
                   "dicts of name, base_color (RGBA) and texture (index)")
      .def_prop_ro("textures", &TexturesOf, "(H, W, C) uint8 each, sRGB")
      .def("__repr__",
           [](const core::TexturedMesh& mesh) { return "Textured" + MeshText(mesh.mesh); });
}

const char* SeverityName(const core::Finding& finding) {
  switch (finding.severity) {
    case core::Severity::kInfo:
      return "info";
    case core::Severity::kWarning:
      return "warning";
    default:
      return "error";
  }
}

void BindFinding(nb::module_& module) {
  nb::class_<core::Finding>(module, "Finding",
                            "What a reader, a check or a linter has to say. Constant.")
      .def_ro("code", &core::Finding::code, "a stable short name")
      .def_prop_ro("severity", &SeverityName, "info, warning or error")
      .def_ro("place", &core::Finding::place, "file, element or line; may be empty")
      .def_ro("sentence", &core::Finding::sentence)
      .def_ro("figure", &core::Finding::figure, "the measured value, if any")
      .def_ro("remedy", &core::Finding::remedy, "what the reader can do; may be empty")
      .def("__repr__", [](const core::Finding& finding) {
        return std::string("Finding(") + SeverityName(finding) + " " + finding.code + ": " +
               finding.sentence + ")";
      });
}

}  // namespace

void BindMeshes(nb::module_& module) {
  BindFinding(module);
  BindTriangleMesh(module);
  BindTexturedMesh(module);
  module.def(
      "read_mesh",
      [](const std::filesystem::path& path) {
        const nb::gil_scoped_release released;
        return assets::ReadMesh(path);
      },
      "path"_a,
      "Reads OBJ, STL, PLY, glTF, GLB, DAE and their archives.\n\n"
      "Raises:\n    Error: if the file is missing, damaged or of another kind.");
}

}  // namespace simwright::python
