#pragma once

#include <nanobind/nanobind.h>

namespace simwright::python {

// Each adds one group of classes and functions to the module.
void BindMeshes(nanobind::module_& module);
void BindAssets(nanobind::module_& module);
void BindGeometry(nanobind::module_& module);
void BindRendering(nanobind::module_& module);
void BindPhysics(nanobind::module_& module);
void BindRewards(nanobind::module_& module);
void BindTasks(nanobind::module_& module);
void BindSkills(nanobind::module_& module);
void BindCameras(nanobind::module_& module);
void BindEnvironments(nanobind::module_& module);
void BindScenes(nanobind::module_& module);

}  // namespace simwright::python
