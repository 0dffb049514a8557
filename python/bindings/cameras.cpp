#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "python/bindings/bindings.h"
#include "python/bindings/prepared_task.h"
#include "skills/episode_cameras.h"

namespace simwright::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using render::CameraSpec;
using render::LookRanges;
using render::ValueRange;

void MakeSpec(CameraSpec* self, const std::string& name, const std::string& mount,
              const Eigen::Matrix4d& pose, int width, int height, double vertical_fov,
              const std::optional<std::array<double, 4>>& intrinsics) {
  CameraSpec spec;
  spec.name = name;
  spec.mount = mount;
  spec.mount_from_camera.matrix() = pose;
  spec.width = width;
  spec.height = height;
  spec.vertical_fov = vertical_fov;
  if (intrinsics) {
    const auto& [fx, fy, cx, cy] = *intrinsics;
    spec.intrinsics = {fx, fy, cx, cy};
  }
  std::string error;
  if (!spec.IsValid(&error)) throw core::Error(error);
  new (self) CameraSpec(std::move(spec));
}

void BindSpec(nb::module_& module) {
  nb::class_<CameraSpec>(module, "CameraSpec", "Where a camera is mounted, its image and its lens.")
      .def("__init__", &MakeSpec, "name"_a, "mount"_a, "pose"_a, "width"_a, "height"_a,
           "vertical_fov"_a, "intrinsics"_a.none())
      .def_ro("name", &CameraSpec::name, "its key in observations")
      .def_ro("mount", &CameraSpec::mount, "world, robot, wrist or a link of the robot")
      .def_prop_ro(
          "pose",
          [](const CameraSpec& spec) { return Eigen::Matrix4d(spec.mount_from_camera.matrix()); },
          "(4, 4) mount from camera, m; +z forward, x right, y down")
      .def_ro("width", &CameraSpec::width, "pixels")
      .def_ro("height", &CameraSpec::height, "pixels")
      .def_ro("vertical_fov", &CameraSpec::vertical_fov, "rad")
      .def("__repr__", [](const CameraSpec& spec) {
        return "CameraSpec(" + spec.name + ", on " + spec.mount + ", " +
               std::to_string(spec.width) + " x " + std::to_string(spec.height) + ")";
      });
  module.def("default_cameras", &skills::DefaultCameras, "width"_a, "height"_a);
  module.def(
      "look_at",
      [](const Eigen::Vector3d& position, const Eigen::Vector3d& target,
         const Eigen::Vector3d& up) {
        return Eigen::Matrix4d(render::LookAt(position, target, up).matrix());
      },
      "position"_a, "target"_a, "up"_a);
}

void BindLook(nb::module_& module) {
  const auto range = [](ValueRange LookRanges::*member) {
    return std::pair(
        [member](const LookRanges& look) {
          return std::pair<double, double>((look.*member).low, (look.*member).high);
        },
        [member](LookRanges& look, const std::pair<double, double>& value) {
          look.*member = {value.first, value.second};
        });
  };
  const auto strength = range(&LookRanges::light_strength), shadow = range(&LookRanges::shadow);
  nb::class_<LookRanges>(module, "LookRanges",
                         "Ranges of a randomised look (docs/cameras.md); all are off by default.")
      .def(nb::init<>())
      .def_static("wide", &LookRanges::Wide, "Returns the ranges of the look \"wide\".")
      .def(
          "check",
          [](const LookRanges& look) {
            std::string error;
            if (!look.IsValid(&error))
              throw core::Error(error, "look", "docs/cameras.md has the ranges");
          },
          "Raises Error for a value outside its bounds.")
      .def_rw("object_color", &LookRanges::object_color, "share of objects in a random colour")
      .def_rw("robot_color", &LookRanges::robot_color, "share of episodes")
      .def_rw("tint", &LookRanges::tint, "amount per channel, [0, 1)")
      .def_rw("object_pattern", &LookRanges::object_pattern, "share of objects with a pattern")
      .def_rw("floor_color", &LookRanges::floor_color, "share of episodes")
      .def_rw("floor_pattern", &LookRanges::floor_pattern, "share of episodes")
      .def_rw("walls", &LookRanges::walls, "share of episodes with four walls")
      .def_rw("background", &LookRanges::background, "share of episodes")
      .def_rw("light_angle", &LookRanges::light_angle, "rad, amount")
      .def_rw("light_color", &LookRanges::light_color, "amount per channel, [0, 1)")
      .def_prop_rw("light_strength", strength.first, strength.second, "(low, high) factor")
      .def_prop_rw("shadow", shadow.first, shadow.second, "(low, high) share, in [0, 1]")
      .def_rw("camera_position", &LookRanges::camera_position, "m, amount per axis")
      .def_rw("camera_angle", &LookRanges::camera_angle, "rad, amount per axis")
      .def_rw("camera_fov", &LookRanges::camera_fov, "share of the focal length, amount");
}

}  // namespace

void BindCameras(nb::module_& module) {
  BindSpec(module);
  BindLook(module);
  using skills::EpisodeCameras;
  nb::class_<EpisodeCameras>(module, "EpisodeCameras",
                             "The cameras of a subtask's episodes. Constant and thread-safe.")
      .def(
          "__init__",
          [](EpisodeCameras* self, const PreparedTask& task, int subtask, bool evaluated,
             const std::vector<CameraSpec>& cameras, const LookRanges& look, int samples_per_side) {
            const nb::gil_scoped_release released;
            new (self)
                EpisodeCameras(task.SkillAt(subtask, evaluated), cameras, {look, samples_per_side});
          },
          "task"_a, "subtask"_a, "evaluated"_a, "cameras"_a, "look"_a, "samples_per_side"_a)
      .def_prop_ro("cameras", &EpisodeCameras::cameras)
      .def(
          "legend",
          [](const EpisodeCameras& cameras, int variant) {
            nb::dict names;
            for (const skills::LabelName& label : cameras.Legend(variant)) {
              names[nb::int_(label.label)] = label.name;
            }
            return names;
          },
          "variant"_a);
}

}  // namespace simwright::python
