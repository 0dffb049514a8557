#include "robot/demonstration_file.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/hdf5.h"
#include "core/json.h"
#include "robot/number_text.h"

namespace simwright::robot {
namespace {

constexpr core::Hdf5Storage kPacked{.rows_per_chunk = 256, .gzip = 4};
constexpr core::Hdf5Storage kPackedImages{.rows_per_chunk = 1, .gzip = 4};
constexpr double kActionSlack = 1e-6;  // rounding of single precision

std::string NameOf(std::size_t index) {
  return "demo_" + std::to_string(index);
}

template <typename T>
void RequireSteps(const core::Hdf5Array<T>& array, std::size_t steps, const std::string& place) {
  std::size_t count = 1;
  for (const std::size_t size : array.shape) count *= size;
  if (array.shape.empty() || array.shape[0] != steps || count != array.values.size()) {
    throw core::Error(
        "the array's shape does not fit its values or the " + std::to_string(steps) + " steps",
        place);
  }
  if constexpr (std::is_floating_point_v<T>) {
    for (const T value : array.values) {
      if (!std::isfinite(value)) throw core::Error("a number is not finite", place);
    }
  }
}

void RequireObservations(const StepObservations& seen, std::size_t steps,
                         const std::string& place) {
  const auto require_key = [&](const std::string& key) {
    if (!key.empty() && key.find('/') == std::string::npos && key != ".") return;
    throw core::Error("'" + key + "' is not a valid observation key", place);
  };
  for (const auto& [key, array] : seen.numbers) {
    require_key(key);
    RequireSteps(array, steps, place + "/" + key);
    if (seen.images.contains(key)) {
      throw core::Error("two observations have the key '" + key + "'", place);
    }
  }
  for (const auto& [key, array] : seen.images) {
    require_key(key);
    RequireSteps(array, steps, place + "/" + key);
  }
}

void RequireWellFormed(const Demonstration& demonstration, const std::string& place) {
  const std::size_t steps = demonstration.size();
  if (steps == 0) throw core::Error("the demonstration has no steps", place);
  if (demonstration.dones.size() != steps) {
    throw core::Error("there are " + std::to_string(demonstration.dones.size()) + " dones for " +
                          std::to_string(steps) + " rewards",
                      place);
  }
  RequireSteps(demonstration.actions, steps, place + "/actions");
  RequireSteps(demonstration.states, steps, place + "/states");
  RequireSteps(core::Hdf5Array<double>{{steps}, demonstration.rewards}, steps, place + "/rewards");
  for (const double action : demonstration.actions.values) {
    if (std::abs(action) <= 1.0 + kActionSlack) continue;
    throw core::Error("an action is " + std::to_string(action) + ", outside [-1, 1]",
                      place + "/actions", "scale the actions");
  }
  RequireObservations(demonstration.observations, steps, place + "/obs");
  RequireObservations(demonstration.next_observations, steps, place + "/next_obs");
}

void RequireWellFormed(const DemonstrationSet& set, const std::string& where) {
  if (set.demonstrations.empty()) throw core::Error("there are no demonstrations", where);
  if (!set.metadata.empty() && set.metadata.size() != set.demonstrations.size()) {
    throw core::Error("there are " + std::to_string(set.metadata.size()) + " notes for " +
                          std::to_string(set.demonstrations.size()) + " demonstrations",
                      where + "/simwright/notes");
  }
  for (std::size_t i = 0; i < set.demonstrations.size(); ++i) {
    RequireWellFormed(set.demonstrations[i], where + "/data/" + NameOf(i));
  }
  for (const auto& [name, indices] : set.filters) {
    if (name.empty() || name.find('/') != std::string::npos) {
      throw core::Error("'" + name + "' is not a valid filter name", where);
    }
    for (const std::size_t index : indices) {
      if (index < set.demonstrations.size()) continue;
      throw core::Error("the filter names " + NameOf(index) + ", which does not exist",
                        where + "/mask/" + name);
    }
  }
}

void WriteObservations(const StepObservations& seen, const std::string& name,
                       core::Hdf5Group* demonstration) {
  core::Hdf5Group group = demonstration->Create(name);
  for (const auto& [key, array] : seen.numbers) {
    group.Write(key, array.shape, array.values.data(), kPacked);
  }
  for (const auto& [key, array] : seen.images) {
    group.Write(key, array.shape, array.values.data(), kPackedImages);
  }
}

void WriteDemonstration(const Demonstration& demonstration, core::Hdf5Group group) {
  const std::size_t steps = demonstration.size();
  group.SetAttribute("num_samples", static_cast<std::int64_t>(steps));
  group.Write("actions", demonstration.actions.shape, demonstration.actions.values.data(), kPacked);
  group.Write("states", demonstration.states.shape, demonstration.states.values.data(), kPacked);
  group.Write("rewards", {steps}, demonstration.rewards.data(), kPacked);
  const std::vector<std::int64_t> dones(demonstration.dones.begin(), demonstration.dones.end());
  group.Write("dones", {steps}, dones.data(), kPacked);
  WriteObservations(demonstration.observations, "obs", &group);
  WriteObservations(demonstration.next_observations, "next_obs", &group);
}

// Reads the observations; arrays with four dimensions are images.
StepObservations ReadObservations(const core::Hdf5Group& demonstration, const std::string& name) {
  StepObservations seen;
  if (!demonstration.Has(name)) return seen;
  const core::Hdf5Group group = demonstration.Open(name);
  for (const std::string& key : group.Children()) {
    if (group.Shape(key).size() == 4) {
      seen.images[key] = group.Read<std::uint8_t>(key);
    } else {
      const core::Hdf5Array<double> array = group.Read<double>(key);
      seen.numbers[key] = {array.shape, {array.values.begin(), array.values.end()}};
    }
  }
  return seen;
}

Demonstration ReadDemonstration(const core::Hdf5Group& group, const std::string& place) {
  Demonstration demonstration;
  demonstration.actions = group.Read<double>("actions");
  demonstration.states = group.Read<double>("states");
  demonstration.rewards = group.Read<double>("rewards").values;
  for (const std::int64_t done : group.Read<std::int64_t>("dones").values) {
    demonstration.dones.push_back(done != 0);
  }
  demonstration.observations = ReadObservations(group, "obs");
  demonstration.next_observations = ReadObservations(group, "next_obs");
  if (group.IntegerAttribute("num_samples") != static_cast<std::int64_t>(demonstration.size())) {
    throw core::Error("num_samples is not the number of rewards", place);
  }
  return demonstration;
}

// Returns the number of a demonstration: 7 for "demo_7".
std::int64_t NumberOf(const std::string& name, const std::string& where) {
  const std::optional<std::int64_t> number =
      name.starts_with("demo_") ? IntegerFrom(name.substr(5)) : std::nullopt;
  if (!number || *number < 0) throw core::Error("'" + name + "' is not a demonstration", where);
  return *number;
}

void ReadEnvironment(const std::string& env_args, const std::string& where, DemonstrationSet* set) {
  const core::JsonDocument document(env_args, where);
  const core::JsonField root = document.root();
  set->env_name = root["env_name"].Name();
  set->env_type = root["type"].Int();
  if (root.Has("env_version")) set->env_version = root["env_version"].Name();
  const core::JsonField kwargs = root["env_kwargs"];
  if (!kwargs.json().is_object()) kwargs.FailAs("an object");
  set->env_kwargs = core::JsonLine(kwargs.json());
}

}  // namespace

void WriteDemonstrations(const std::filesystem::path& path, const DemonstrationSet& set) {
  const std::string where = path.string();
  RequireWellFormed(set, where);
  const core::Json kwargs = core::ParseJson(set.env_kwargs, where + ": env_kwargs");
  if (!kwargs.is_object()) throw core::Error("env_kwargs is not a JSON object", where);
  core::OrderedJson env_args;
  env_args["env_name"] = set.env_name;
  if (!set.env_version.empty()) env_args["env_version"] = set.env_version;
  env_args["type"] = set.env_type;
  env_args["env_kwargs"] = kwargs;

  core::Hdf5Writer writer(path);
  core::Hdf5Group data = writer.root().Create("data");
  std::int64_t total = 0;
  for (std::size_t i = 0; i < set.demonstrations.size(); ++i) {
    WriteDemonstration(set.demonstrations[i], data.Create(NameOf(i)));
    total += static_cast<std::int64_t>(set.demonstrations[i].size());
  }
  data.SetAttribute("total", total);
  data.SetAttribute("env_args", env_args.dump(-1, ' ', true, core::Json::error_handler_t::replace));
  if (!set.filters.empty()) {
    core::Hdf5Group mask = writer.root().Create("mask");
    for (const auto& [name, indices] : set.filters) {
      std::vector<std::string> names;
      for (const std::size_t index : indices) names.push_back(NameOf(index));
      mask.WriteTexts(name, names);
    }
  }
  if (!set.metadata.empty()) writer.root().Create("simwright").WriteTexts("notes", set.metadata);
  writer.Commit();
}

DemonstrationSet ReadDemonstrations(const std::filesystem::path& path) {
  const std::string where = path.string();
  const core::Hdf5Reader reader(path);
  const core::Hdf5Group data = reader.root().Open("data");
  DemonstrationSet set;
  ReadEnvironment(data.TextAttribute("env_args"), where + ": env_args", &set);
  std::map<std::int64_t, std::string> names;
  for (const std::string& name : data.Children()) names[NumberOf(name, where)] = name;
  std::map<std::string, std::size_t> place_of;
  std::int64_t total = 0;
  for (const auto& [number, name] : names) {
    place_of[name] = set.demonstrations.size();
    set.demonstrations.push_back(ReadDemonstration(data.Open(name), where + "/data/" + name));
    total += static_cast<std::int64_t>(set.demonstrations.back().size());
  }
  if (data.IntegerAttribute("total") != total) {
    throw core::Error("'total' is not the number of all steps, " + std::to_string(total), where);
  }
  if (reader.root().Has("mask")) {
    const core::Hdf5Group mask = reader.root().Open("mask");
    for (const std::string& filter : mask.Children()) {
      std::vector<std::size_t>& indices = set.filters[filter];
      for (const std::string& name : mask.ReadTexts(filter)) {
        const auto found = place_of.find(name);
        if (found == place_of.end()) {
          throw core::Error("the filter names '" + name + "', which does not exist",
                            where + "/mask/" + filter);
        }
        indices.push_back(found->second);
      }
    }
  }
  if (reader.root().Has("simwright")) {
    set.metadata = reader.root().Open("simwright").ReadTexts("notes");
  }
  RequireWellFormed(set, where);
  return set;
}

}  // namespace simwright::robot
