#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "core/parallel.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "reward/reward_program.h"
#include "tasks/world_state.h"
#include "workflows/tasks/task_assets.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
using reward::RewardSlot;
using InputArray = nb::ndarray<const float, nb::c_contig, nb::device::cpu>;

// Environments that one thread computes at a time.
constexpr int kBlock = 1024;

// Returns the key of a slot in the dict of inputs: "drawer_position" for a parameter,
// "link_position/cup/handle" for what a scene provides.
std::string KeyOf(const RewardSlot& slot) {
  if (slot.input == reward::RewardInput::kParameter) return slot.part;
  std::string key(reward::RewardInputName(slot.input));
  for (const std::string& name : {slot.asset, slot.part}) {
    if (!name.empty()) key += "/" + name;
  }
  return key;
}

// A compiled program with the memory of the threads that run it.
class BoundProgram {
 public:
  BoundProgram(reward::RewardProgram program, core::Findings findings)
      : program_(std::move(program)), findings_(std::move(findings)) {}

  const reward::RewardProgram& program() const { return program_; }
  const core::Findings& findings() const { return findings_; }

  // Returns the reward (N), the success (N) or None, and the components by name.
  nb::tuple Run(const std::map<std::string, InputArray>& inputs, int count) const {
    if (count < 1) throw core::Error("must be at least 1", "count");
    const std::vector<reward::RewardBinding> bindings = BindingsOf(inputs, count);
    const auto rows = static_cast<size_t>(count);
    auto [rewards, reward_memory] = NewArray<float>({rows});
    auto [success, success_memory] = NewArray<bool>({rows});
    static_assert(sizeof(bool) == sizeof(std::uint8_t));
    nb::dict components;
    std::vector<float*> component_memory;
    for (const reward::RewardComponent& component : program_.components()) {
      auto [array, memory] = component.width == 1
                                 ? NewArray<float>({rows})
                                 : NewArray<float>({rows, static_cast<size_t>(component.width)});
      components[component.name.c_str()] = array;
      component_memory.push_back(memory);
    }
    {
      const nb::gil_scoped_release released;
      RunBlocks(bindings, count, reward_memory, reinterpret_cast<std::uint8_t*>(success_memory),
                component_memory);
    }
    return nb::make_tuple(rewards, program_.has_success() ? nb::cast(success) : nb::none(),
                          components);
  }

 private:
  std::vector<reward::RewardBinding> BindingsOf(const std::map<std::string, InputArray>& inputs,
                                                int count) const {
    std::vector<reward::RewardBinding> bindings;
    std::map<std::string, int> used;
    for (const RewardSlot& slot : program_.slots()) {
      const std::string key = KeyOf(slot);
      const auto found = inputs.find(key);
      if (found == inputs.end()) {
        throw core::Error("is missing", "the input '" + key + "'",
                          "give an array of shape " + slot.shape);
      }
      const auto rows = static_cast<size_t>(slot.uniform ? 1 : count);
      if (found->second.size() != rows * static_cast<size_t>(slot.width)) {
        throw core::Error(
            "has " + std::to_string(found->second.size()) + " numbers", "the input '" + key + "'",
            "give an array of shape " + slot.shape + " with N = " + std::to_string(count));
      }
      bindings.push_back({found->second.data()});
      ++used[key];
    }
    for (const auto& [key, array] : inputs) {
      if (!used.contains(key)) {
        throw core::Error("is not read by the program", "the input '" + key + "'", "leave it out");
      }
    }
    return bindings;
  }

  void RunBlocks(const std::vector<reward::RewardBinding>& bindings, int count, float* rewards,
                 std::uint8_t* success, const std::vector<float*>& components) const {
    const std::vector<RewardSlot>& slots = program_.slots();
    const std::vector<reward::RewardComponent> parts = program_.components();
    const int blocks = (count + kBlock - 1) / kBlock;
    core::ParallelFor(blocks, [&](int block) {
      const int first = block * kBlock, size = std::min(kBlock, count - first);
      std::vector<reward::RewardBinding> here = bindings;
      for (size_t i = 0; i < here.size(); ++i) {
        if (!slots[i].uniform) here[i].data += static_cast<ptrdiff_t>(first) * slots[i].width;
      }
      std::vector<float*> outputs = components;
      for (size_t i = 0; i < outputs.size(); ++i) {
        outputs[i] += static_cast<ptrdiff_t>(first) * parts[i].width;
      }
      reward::RewardWorkspace workspace(program_, size);
      program_.Run(here, size, &workspace, rewards + first,
                   program_.has_success() ? success + first : nullptr, outputs);
    });
  }

  reward::RewardProgram program_;
  core::Findings findings_;
};

// Compiles `source` for the assets of `paths`, or without a scene if there are none.
BoundProgram Compile(const std::string& source, const std::vector<std::string>& paths,
                     const std::string& entry,
                     const std::map<std::string, std::vector<int>>& shapes) {
  reward::RewardOptions options;
  options.entry = entry;
  options.parameter_shapes = shapes;
  tasks::WorldModel scene;
  if (!paths.empty()) scene = tasks::MakeWorldModel(workflows::ReadTaskAssets(paths).models);
  reward::CompileOutcome outcome =
      reward::CompileReward(source, paths.empty() ? nullptr : &scene.names, options);
  if (outcome.program) return {std::move(*outcome.program), std::move(outcome.findings)};
  for (const core::Finding& finding : outcome.findings) {
    if (finding.severity != core::Severity::kError) continue;
    throw core::Error(finding.sentence, "reward program, " + finding.place, finding.remedy);
  }
  throw core::Error("does not compile", "reward program");
}

nb::list SlotsOf(const BoundProgram& program) {
  nb::list slots;
  for (const RewardSlot& slot : program.program().slots()) {
    nb::dict dict;
    dict["key"] = KeyOf(slot);
    dict["input"] = std::string(reward::RewardInputName(slot.input));
    dict["asset"] = slot.asset;
    dict["part"] = slot.part;
    dict["width"] = slot.width;
    dict["shape"] = slot.shape;
    dict["uniform"] = slot.uniform;
    slots.append(dict);
  }
  return slots;
}

}  // namespace

void BindRewards(nb::module_& module) {
  nb::class_<BoundProgram>(module, "RewardProgram", "A compiled reward function. Constant.")
      .def("run", &BoundProgram::Run, "inputs"_a, "count"_a,
           "Computes `count` environments: `inputs` by key, float32, (N, width) or (N); uniform "
           "ones of one number. Returns reward (N), success (N) or None, and the components.")
      .def_prop_ro("slots", &SlotsOf)
      .def_prop_ro("entry", [](const BoundProgram& program) { return program.program().entry(); })
      .def_prop_ro("has_success",
                   [](const BoundProgram& program) { return program.program().has_success(); })
      .def_prop_ro("operations",
                   [](const BoundProgram& program) { return program.program().operations(); })
      .def_prop_ro("findings", &BoundProgram::findings);
  module.def("compile_reward", &Compile, "source"_a, "assets"_a, "entry"_a, "shapes"_a,
             nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace simwright::python
