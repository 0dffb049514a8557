#include "library_fit/fit_kinds.h"

#include <algorithm>
#include <map>

#include "core/random.h"

namespace simwright::library_fit {
namespace {

library::Options OptionsOf(const Instance& instance) {
  library::Options options;
  options.seed = instance.seed;
  options.draws = instance.draws;
  options.size = instance.size;
  return options;
}

// Returns the position of the first moving joint, by its name.
std::map<std::string, double> PositionsOf(const assets::ArticulatedAsset& asset, double opening) {
  for (const assets::Joint& joint : asset.joints) {
    if (joint.Moves()) return {{joint.name, joint.lower + opening * (joint.upper - joint.lower)}};
  }
  return {};
}

// Returns the categories of the instances of the first seeds.
std::vector<std::string> CategoriesOf(const library::Kind& kind) {
  std::vector<std::string> categories;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    library::Options options;
    options.seed = seed;
    options.appearance_only = true;
    const std::string category = kind.make(options).parameters.category;
    if (std::find(categories.begin(), categories.end(), category) == categories.end()) {
      categories.push_back(category);
    }
  }
  return categories;
}

}  // namespace

const std::vector<FitKind>& FitKinds() {
  static const std::vector<FitKind> kKinds = [] {
    std::vector<FitKind> all;
    for (const library::Kind& kind : library::Kinds()) {
      const double opening = kind.name == "laptop" ? 1.0 : 0.0;
      all.push_back({kind.name, CategoriesOf(kind), &kind, nullptr, opening});
    }
    for (const library::RigidKind& kind : library::RigidKinds()) {
      all.push_back({kind.name, {kind.category}, nullptr, &kind, 0.0});
    }
    return all;
  }();
  return kKinds;
}

std::vector<int> KindsOfCategory(const std::string& category) {
  const auto matching = [](const std::string& name) {
    std::vector<int> kinds;
    for (size_t i = 0; i < FitKinds().size(); ++i) {
      const std::vector<std::string>& rows = FitKinds()[i].categories;
      if (name == "object" || std::find(rows.begin(), rows.end(), name) != rows.end()) {
        kinds.push_back(static_cast<int>(i));
      }
    }
    return kinds;
  };
  const std::vector<int> kinds = matching(category);
  const size_t space = category.rfind(' ');
  if (!kinds.empty() || space == std::string::npos) return kinds;
  return matching(category.substr(space + 1));
}

int FindFitKind(const std::string& name) {
  for (size_t i = 0; i < FitKinds().size(); ++i) {
    if (FitKinds()[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

Instance SampleInstance(int kind, std::uint64_t seed) {
  const FitKind& of = FitKinds().at(static_cast<size_t>(kind));
  Instance instance;
  instance.kind = kind;
  instance.seed = seed;
  library::Options options;
  options.seed = seed;
  options.record = &instance.draws;
  options.appearance_only = true;
  if (of.articulated != nullptr) {
    const assets::ArticulatedAsset asset = of.articulated->make(options);
    const physics_params::PhysicalParameters& p = asset.parameters;
    instance.size = {p.length.sample, p.width.sample, p.height.sample};
  } else {
    instance.size = library::MakeRigidObject(*of.rigid, options).size;
  }
  core::Rng rng = core::StreamRng(seed, 7919);
  if (of.opening > 0.0) instance.opening = core::Uniform(rng, 0.0, of.opening);
  return instance;
}

core::TexturedMesh InstanceMesh(const Instance& instance) {
  const FitKind& of = FitKinds().at(static_cast<size_t>(instance.kind));
  library::Options options = OptionsOf(instance);
  options.appearance_only = true;
  if (of.rigid != nullptr) return library::MakeRigidObject(*of.rigid, options).visual;
  const assets::ArticulatedAsset asset = of.articulated->make(options);
  return assets::VisualAtPositions(asset, instance.opening > 0.0
                                              ? PositionsOf(asset, instance.opening)
                                              : std::map<std::string, double>{});
}

assets::ArticulatedAsset InstanceAsset(const Instance& instance) {
  return FitKinds().at(static_cast<size_t>(instance.kind)).articulated->make(OptionsOf(instance));
}

library::RigidObject InstanceObject(const Instance& instance) {
  return library::MakeRigidObject(*FitKinds().at(static_cast<size_t>(instance.kind)).rigid,
                                  OptionsOf(instance));
}

}  // namespace simwright::library_fit
