#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/set.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/reports.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/feasibility/feasible_scene.h"
#include "scene/metrics/penetration.h"
#include "scene/scene_types/scene_types.h"
#include "workflows/scenes/scene_evaluation.h"
#include "workflows/scenes/scene_export.h"
#include "workflows/scenes/scene_generation.h"
#include "workflows/scenes/scene_sampling.h"
#include "workflows/scenes/scene_steering.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
namespace fs = std::filesystem;
using scene::SceneObject;

void MakeSceneObject(SceneObject* self, const std::string& category, const Eigen::Matrix4d& pose,
                     bool welded) {
  const bool rigid = pose.allFinite() &&
                     (pose.row(3) - Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)).norm() < 1e-9 &&
                     (pose.topLeftCorner<3, 3>() * pose.topLeftCorner<3, 3>().transpose() -
                      Eigen::Matrix3d::Identity())
                             .norm() < 1e-6 &&
                     pose.topLeftCorner<3, 3>().determinant() > 0.0;
  if (!rigid) {
    throw core::Error("is not a rigid transform", "pose",
                      "give a (4, 4) matrix with a proper rotation");
  }
  new (self) SceneObject();
  self->category = category;
  self->welded = welded;
  self->world_from_object.matrix() = pose;
}

void BindSceneObject(nb::module_& module) {
  nb::class_<SceneObject>(module, "SceneObject", "An object of a scene. Constant.")
      .def("__init__", &MakeSceneObject, "category"_a, "pose"_a, "welded"_a = false)
      .def_ro("category", &SceneObject::category, "of its asset in the AssetSet")
      .def_ro("welded", &SceneObject::welded, "fixed furniture")
      .def_prop_ro(
          "pose",
          [](const SceneObject& object) {
            return Eigen::Matrix4d(object.world_from_object.matrix());
          },
          "(4, 4) world from object, m")
      .def("__repr__",
           [](const SceneObject& object) { return "SceneObject(" + object.category + ")"; });
  nb::class_<scene::AssetSet>(module, "AssetSet", "The assets of scenes by category. Constant.")
      .def_static("read", nb::overload_cast<const fs::path&>(&scene::ReadAssetSet), "folder"_a,
                  nb::call_guard<nb::gil_scoped_release>(),
                  "Reads the rigid asset folders of a folder; teapot_3 has the category teapot.\n\n"
                  "Raises:\n    Error: if an asset is damaged, or there is none.")
      .def("__contains__", &scene::AssetSet::Has, "category"_a);
}

nb::list ReadScenes(const fs::path& path, int first, int count) {
  const scene::SceneDataset dataset(path);
  const int most = dataset.SceneCount() - first;
  if (first < 0 || most < 0) throw core::Error("is outside of the dataset", "first");
  const int read = count < 0 ? most : std::min(count, most);
  nb::list scenes;
  for (const std::vector<SceneObject>& objects :
       scene::DecodeScenes(dataset.Read(first, read), dataset.vocabulary())) {
    nb::list list;
    for (SceneObject object : objects) {
      const int known = dataset.vocabulary().ClassOf(object.category);
      if (known >= 0) object.welded = dataset.vocabulary().welded[static_cast<size_t>(known)];
      list.append(nb::cast(std::move(object)));
    }
    scenes.append(list);
  }
  return scenes;
}

nb::dict MakeFeasible(const std::vector<SceneObject>& objects, const scene::AssetSet& asset_set,
                      int min_objects, double lowering, const nb::object& report) {
  scene::FeasibilityOptions options;
  options.min_objects = min_objects;
  options.lowering = lowering;
  const scene::FeasibleScene feasible = RunLong(report, [&](core::Progress* /*progress*/) {
    return scene::MakeFeasible(objects, asset_set, options);
  });
  nb::dict dict;
  dict["valid"] = feasible.valid;
  dict["objects"] = feasible.objects;
  dict["indices"] = feasible.indices;
  dict["dropped"] = feasible.dropped;
  dict["moved"] = feasible.moved;
  dict["penetration"] = feasible.penetration;
  dict["drift"] = feasible.drift;
  return dict;
}

nb::object Generate(const std::string& type, int count, const fs::path& output,
                    const std::vector<fs::path>& assets, std::uint64_t seed, bool raw,
                    const nb::object& report) {
  workflows::SceneGenerationRequest request;
  request.type = type;
  request.count = count;
  request.output = output;
  request.assets = assets;
  request.seed = seed;
  request.raw = raw;
  return FromJson(workflows::StatisticsJson(RunLong(report, [&](core::Progress* progress) {
    return workflows::GenerateScenes(request, progress);
  })));
}

nb::object Sample(const fs::path& output, const fs::path& weights, const std::string& type,
                  int count, const std::vector<std::string>& prompts, int steps, double guidance,
                  const std::vector<fs::path>& assets, std::uint64_t seed, bool raw, bool force,
                  const nb::object& report) {
  workflows::SceneSamplingRequest request;
  request.output = output;
  request.weights = weights;
  request.type = type;
  request.count = count;
  request.prompts = prompts;
  request.sampling.steps = steps;
  request.sampling.guidance = guidance;
  request.sampling.seed = seed;
  request.assets = assets;
  request.raw = raw;
  request.force = force;
  return FromJson(workflows::SamplingJson(RunLong(report, [&](core::Progress* progress) {
    return workflows::SampleScenes(request, progress);
  })));
}

nb::object Steer(const fs::path& source, const fs::path& output, bool rearrange,
                 const std::string& scenes, int count, const std::string& prompt,
                 const std::vector<std::string>& keep, const fs::path& weights,
                 const std::string& type, std::uint64_t seed, bool force,
                 const nb::object& report) {
  workflows::SceneSteeringRequest request;
  request.scene = source;
  request.output = output;
  request.scenes = scenes;
  request.goal.rearrange = rearrange;
  request.goal.count = count;
  request.goal.keep = keep;
  request.prompt = prompt;
  request.weights = weights;
  request.type = type;
  request.sampling.seed = seed;
  request.force = force;
  return FromJson(workflows::SteeringJson(RunLong(report, [&](core::Progress* progress) {
    return workflows::SteerScenes(request, progress);
  })));
}

nb::object Evaluate(const std::string& type, const fs::path& data, const fs::path& weights,
                    const fs::path& samples, int count, std::uint64_t seed,
                    const nb::object& report) {
  workflows::SceneEvaluationRequest request;
  request.type = type;
  request.data = data;
  request.weights = weights;
  request.samples = samples;
  request.count = count;
  request.seed = seed;
  return FromJson(workflows::EvaluationJson(RunLong(report, [&](core::Progress* progress) {
    return workflows::EvaluateScenes(request, progress);
  })));
}

nb::object ExportWorlds(const fs::path& dataset, const fs::path& output, const std::string& scenes,
                        const std::set<std::string>& formats, bool check, bool force,
                        const nb::object& report) {
  workflows::SceneExportRequest request;
  request.dataset = dataset;
  request.output = output;
  request.scenes = scenes;
  request.formats = formats;
  request.check = check;
  request.force = force;
  return FromJson(workflows::ExportJson(RunLong(report, [&](core::Progress* progress) {
    return workflows::ExportScenes(request, progress);
  })));
}

}  // namespace

void BindScenes(nb::module_& module) {
  BindSceneObject(module);
  module.def("scene_types", [] {
    std::vector<std::string> names;
    for (const scene::SceneType& type : scene::SceneTypes()) names.push_back(type.name);
    return names;
  });
  module.def("read_scenes", &ReadScenes, "path"_a, "first"_a, "count"_a);
  module.def("make_feasible", &MakeFeasible, "objects"_a, "assets"_a, "min_objects"_a, "lowering"_a,
             "report"_a = nb::none());
  module.def(
      "total_penetration",
      [](const std::vector<SceneObject>& objects, const scene::AssetSet& asset_set) {
        return scene::TotalPenetration(objects, asset_set, scene::BodyShape::kParts);
      },
      "objects"_a, "assets"_a);
  module.def("generate_scenes", &Generate, "type"_a, "count"_a, "output"_a, "assets"_a, "seed"_a,
             "raw"_a, "report"_a = nb::none());
  module.def("sample_scenes", &Sample, "output"_a, "weights"_a, "type"_a, "count"_a, "prompts"_a,
             "steps"_a, "guidance"_a, "assets"_a, "seed"_a, "raw"_a, "force"_a,
             "report"_a = nb::none());
  module.def("steer_scenes", &Steer, "source"_a, "output"_a, "rearrange"_a, "scenes"_a, "count"_a,
             "prompt"_a, "keep"_a, "weights"_a, "type"_a, "seed"_a, "force"_a,
             "report"_a = nb::none());
  module.def("evaluate_scenes", &Evaluate, "type"_a, "data"_a, "weights"_a, "samples"_a, "count"_a,
             "seed"_a, "report"_a = nb::none());
  module.def("export_worlds", &ExportWorlds, "dataset"_a, "output"_a, "scenes"_a, "formats"_a,
             "check"_a, "force"_a, "report"_a = nb::none());
}

}  // namespace simwright::python
