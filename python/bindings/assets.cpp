#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "assets/articulated_folder.h"
#include "assets/articulated_writer.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "library/articulated/articulated_kinds.h"
#include "library/rigid/rigid_kinds.h"
#include "physics_params/category_resolution.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/reports.h"
#include "validation/check.h"
#include "workflows/import/import.h"
#include "workflows/library/library.h"
#include "workflows/lift/lift.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
namespace fs = std::filesystem;

void BindRigidAsset(nb::module_& module) {
  using assets::Asset;
  nb::class_<Asset>(module, "Asset",
                    "A rigid, simulation-ready object: metres, z up, z = 0 at its base. Constant.")
      .def_ro("name", &Asset::name, "of its folder and files")
      .def_prop_ro(
          "category", [](const Asset& asset) { return asset.parameters.category; },
          "its row of the knowledge base")
      .def_prop_ro(
          "material", [](const Asset& asset) { return asset.parameters.material; },
          "its main material")
      .def_ro("visual", &Asset::visual, "TexturedMesh: what is seen")
      .def_ro("solid", &Asset::solid, "Mesh: closed, outward; gives mass and inertia")
      .def_ro("parts", &Asset::parts, "list of Mesh: closed, convex, for contacts")
      .def_prop_ro(
          "mass", [](const Asset& asset) { return asset.inertial.mass; }, "kg")
      .def_prop_ro(
          "center_of_mass", [](const Asset& asset) { return asset.inertial.center_of_mass; },
          "(3) m")
      .def_prop_ro(
          "inertia", [](const Asset& asset) { return asset.inertial.inertia; },
          "(3, 3) kg m^2, about the centre of mass")
      .def_ro("volume", &Asset::volume, "m^3, enclosed by the solid")
      .def_ro("density", &Asset::density, "kg/m^3, of the material")
      .def_ro("wall_thickness", &Asset::wall_thickness, "m; 0: full")
      .def_ro("friction", &Asset::friction, "Coulomb coefficient")
      .def_ro("restitution", &Asset::restitution, "coefficient, in [0, 1]")
      .def_ro("rolling_friction", &Asset::rolling_friction, "m")
      .def_ro("concavity", &Asset::concavity, "of the parts, relative to the diagonal")
      .def_ro("scale", &Asset::scale, "metres per unit of the input")
      .def_ro("source", &Asset::source, "the photo or mesh it was made from")
      .def_ro("seed", &Asset::seed, "of the sampled parameters")
      .def_ro("findings", &Asset::findings, "list of Finding")
      .def("__repr__", [](const Asset& asset) { return "Asset(" + asset.name + ")"; });
}

void BindArticulatedAsset(nb::module_& module) {
  using assets::ArticulatedAsset;
  using assets::ArticulatedLink;
  nb::class_<ArticulatedLink>(module, "Link", "A rigid link of an articulated asset. Constant.")
      .def_ro("name", &ArticulatedLink::name, "unique in its asset")
      .def_ro("label", &ArticulatedLink::label, "its role: door, handle ...")
      .def_ro("visual", &ArticulatedLink::visual, "TexturedMesh: what is seen, in the link's frame")
      .def_ro("parts", &ArticulatedLink::parts, "list of Mesh: closed, convex, for contacts")
      .def_prop_ro(
          "mass", [](const ArticulatedLink& link) { return link.inertial.mass; }, "kg")
      .def_prop_ro(
          "center_of_mass",
          [](const ArticulatedLink& link) { return link.inertial.center_of_mass; }, "(3) m")
      .def_prop_ro(
          "inertia", [](const ArticulatedLink& link) { return link.inertial.inertia; },
          "(3, 3) kg m^2, about the centre of mass")
      .def_ro("friction", &ArticulatedLink::friction, "Coulomb coefficient")
      .def("__repr__", [](const ArticulatedLink& link) { return "Link(" + link.name + ")"; });
  nb::class_<ArticulatedAsset>(
      module, "ArticulatedAsset",
      "An object with joints, which are closed, off or up at position 0. Constant.")
      .def_ro("name", &ArticulatedAsset::name, "of its folder and files")
      .def_prop_ro(
          "category", [](const ArticulatedAsset& asset) { return asset.parameters.category; },
          "its row of the knowledge base")
      .def_ro("fixed", &ArticulatedAsset::fixed, "mounted on a wall, a floor or a counter")
      .def_ro("links", &ArticulatedAsset::links, "list of Link, the root first")
      .def_prop_ro(
          "joints",
          [](const ArticulatedAsset& asset) {
            nb::list joints;
            for (size_t i = 0; i < asset.joints.size(); ++i) {
              const assets::Joint& joint = asset.joints[i];
              nb::dict dict;
              dict["name"] = joint.name;
              dict["type"] = assets::JointTypeName(joint.type);
              dict["child"] = asset.links[i + 1].name;
              dict["axis"] = joint.axis;
              dict["lower"] = joint.lower;
              dict["upper"] = joint.upper;
              joints.append(dict);
            }
            return joints;
          },
          "dicts of name, type, child, axis (3), lower and upper (rad or m)")
      .def("visual", &assets::VisualAtPositions, "positions"_a = std::map<std::string, double>(),
           "Returns all visuals as one TexturedMesh, joints at `positions` (by name; rad or m).")
      .def_ro("seed", &ArticulatedAsset::seed, "of the sampled parameters")
      .def_ro("findings", &ArticulatedAsset::findings, "list of Finding")
      .def("__repr__",
           [](const ArticulatedAsset& asset) { return "ArticulatedAsset(" + asset.name + ")"; });
}

nb::object ReadAnyAsset(const fs::path& folder) {
  if (!fs::exists(folder)) throw core::Error("no such folder", folder.string());
  if (!assets::IsAssetFolder(folder)) {
    throw core::Error("has no asset.json", folder.string(), "give a folder made by lift or import");
  }
  if (assets::IsArticulatedAssetFolder(folder))
    return nb::cast(assets::ReadArticulatedAsset(folder));
  return nb::cast(assets::ReadAsset(folder));
}

template <typename Outcome>
void AddOutcome(const Outcome& outcome, nb::dict* dict) {
  (*dict)["name"] = outcome.name;
  (*dict)["folder"] = outcome.folder.empty() ? nb::none() : nb::cast(outcome.folder);
  (*dict)["refusal"] = outcome.refusal;
  (*dict)["findings"] = outcome.findings;
  if (outcome.check) (*dict)["grade"] = validation::GradeName(outcome.check->grade());
}

nb::list ImportAssets(const std::vector<fs::path>& inputs, const fs::path& output,
                      const std::string& category, const std::string& up, double unit,
                      double height, std::uint64_t seed, bool check, bool force,
                      const nb::object& report) {
  workflows::ImportOptions options;
  options.category = category;
  options.up = up.empty() ? '\0' : up[0];
  options.unit_stated = unit > 0.0;
  if (unit > 0.0) options.unit = unit;
  options.height = height;
  options.seed = seed;
  options.check = check;
  options.force = force;
  if (!up.empty() && up != "x" && up != "y" && up != "z") {
    throw core::Error("is '" + up + "'", "up", "give x, y or z");
  }
  if (!category.empty()) physics_params::RequireCategory(category);
  const auto outcomes = RunLong(report, [&](core::Progress* progress) {
    return workflows::ImportAll(workflows::ListImports(inputs, options), output, options, progress);
  });
  nb::list list;
  for (const workflows::ImportOutcome& outcome : outcomes) {
    nb::dict dict;
    AddOutcome(outcome, &dict);
    list.append(dict);
  }
  return list;
}

nb::list MakeLibrary(const std::string& kind, int count, std::uint64_t seed, const fs::path& output,
                     bool check, bool force, const nb::object& report) {
  workflows::LibraryOptions options;
  options.kind = kind;
  options.count = count;
  options.seed = seed;
  options.check = check;
  options.force = force;
  const auto outcomes = RunLong(report, [&](core::Progress* progress) {
    return workflows::MakeLibrary(options, output, progress);
  });
  nb::list list;
  for (const workflows::LibraryOutcome& outcome : outcomes) {
    nb::dict dict;
    AddOutcome(outcome, &dict);
    dict["kind"] = outcome.kind;
    list.append(dict);
  }
  return list;
}

nb::dict Lift(const fs::path& photo, const std::string& category, const fs::path& output,
              const std::optional<fs::path>& mask, const std::string& shape, bool fast,
              double height, std::uint64_t seed, bool force, const nb::object& report) {
  workflows::LiftRequest request;
  request.photo = photo;
  request.category = category;
  request.output = output;
  request.mask = mask;
  request.height = height;
  request.seed = seed;
  request.force = force;
  if (fast) request.effort = asset_lift::LiftEffort::kFast;
  if (shape == "auto") {
    request.shape = workflows::LiftShape::kAuto;
  } else if (shape == "fitted") {
    request.shape = workflows::LiftShape::kFitted;
  } else if (shape != "free") {
    throw core::Error("is '" + shape + "'", "shape", "give auto, fitted or free");
  }
  const workflows::LiftOutcome outcome = RunLong(
      report, [&](core::Progress* progress) { return workflows::LiftToFolder(request, progress); });
  nb::dict dict;
  dict["folder"] = outcome.folder;
  dict["silhouette_iou"] = outcome.silhouette_iou;
  dict["findings"] = outcome.findings;
  return dict;
}

nb::object Check(const fs::path& path, const nb::object& report) {
  if (!fs::exists(path)) throw core::Error("no such file or folder", path.string());
  const validation::CheckReport checked = RunLong(report, [&](core::Progress* /*progress*/) {
    return fs::is_directory(path) ? validation::CheckAsset(path) : validation::CheckUrdf(path, "");
  });
  return FromJson(validation::CheckJson(checked));
}

nb::dict LibraryKinds() {
  nb::dict kinds;
  for (const auto& kind : library::Kinds()) kinds[kind.name.c_str()] = kind.what;
  for (const auto& kind : library::RigidKinds()) kinds[kind.name.c_str()] = kind.what;
  for (const auto& kind : library::FurnitureKinds()) kinds[kind.name.c_str()] = kind.what;
  return kinds;
}

}  // namespace

void BindAssets(nb::module_& module) {
  BindRigidAsset(module);
  BindArticulatedAsset(module);
  module.def("read_asset", &ReadAnyAsset, "folder"_a);
  module.def("import_assets", &ImportAssets, "inputs"_a, "output"_a, "category"_a, "up"_a, "unit"_a,
             "height"_a, "seed"_a, "check"_a, "force"_a, "report"_a = nb::none());
  module.def("make_library", &MakeLibrary, "kind"_a, "count"_a, "seed"_a, "output"_a, "check"_a,
             "force"_a, "report"_a = nb::none());
  module.def("library_kinds", &LibraryKinds);
  module.def("lift", &Lift, "photo"_a, "category"_a, "output"_a, "mask"_a.none(), "shape"_a,
             "fast"_a, "height"_a, "seed"_a, "force"_a, "report"_a = nb::none());
  module.def("check", &Check, "path"_a, "report"_a = nb::none());
}

}  // namespace simwright::python
