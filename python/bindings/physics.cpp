#include <string>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "physics_params/category_resolution.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/physical_parameters.h"
#include "python/bindings/bindings.h"

namespace simwright::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;

nb::dict EstimateDict(const physics_params::Estimate& estimate) {
  nb::dict dict;
  dict["min"] = estimate.min;
  dict["max"] = estimate.max;
  dict["sample"] = estimate.sample;
  dict["source"] = estimate.source;
  return dict;
}

}  // namespace

void BindPhysics(nb::module_& module) {
  module.def(
      "sample_parameters",
      [](const std::string& category, std::uint64_t seed) {
        const physics_params::KnowledgeBase& base = physics_params::KnowledgeBase::Shipped();
        const physics_params::Resolution resolution = physics_params::RequireCategory(category);
        const physics_params::PhysicalParameters sampled = physics_params::SampleParameters(
            physics_params::ChosenRow(resolution, {}, base), base, seed);
        nb::dict dict;
        dict["category"] = sampled.category;
        dict["resolution"] = resolution.sentence;
        dict["material"] = sampled.material;
        dict["fill"] = physics_params::FillName(sampled.fill);
        dict["length"] = EstimateDict(sampled.length);
        dict["width"] = EstimateDict(sampled.width);
        dict["height"] = EstimateDict(sampled.height);
        dict["mass"] = EstimateDict(sampled.mass);
        dict["density"] = EstimateDict(sampled.density);
        dict["friction"] = EstimateDict(sampled.friction);
        dict["restitution"] = EstimateDict(sampled.restitution);
        return dict;
      },
      "category"_a, "seed"_a);
  module.def("categories", [] {
    std::vector<std::string> names;
    for (const auto& category : physics_params::KnowledgeBase::Shipped().categories()) {
      names.push_back(category.name);
    }
    return names;
  });
}

}  // namespace simwright::python
