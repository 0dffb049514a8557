#include "scene/feasibility/constrained_scene.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "scene/feasibility/narrow_phase.h"

namespace simwright::scene {
namespace {

constexpr double kTouching = 1e-3;  // m between two objects in contact

// The check of one scene. Objects are numbered as in `scene->objects`.
class FreeCheck {
 public:
  FreeCheck(const std::vector<char>& kept, const AssetSet& asset_set,
            const ConstrainedOptions& options, ConstrainedScene* scene)
      : asset_set_(asset_set), options_(options), scene_(*scene) {
    for (const int index : scene_.indices) kept_.push_back(kept[static_cast<size_t>(index)]);
    held_.assign(kept_.size(), 0);
  }

  void Run() {
    DropPenetrating();
    for (int i = 0; i < options_.checks; ++i) {
      Watch();
      if (scene_.stable) break;
      if (!Disturbed().empty() && !checked_alone_) {
        HoldUnstable();
        if (Disturbed().empty() && !AnyOtherMoves()) continue;
      }
      if (!DropCulprits()) break;
    }
    scene_.penetration = 0.0;
    for (const NarrowPhasePair& pair : Penetrations(0.0)) {
      scene_.penetration = std::max(scene_.penetration, -pair.distance);
    }
  }

 private:
  size_t size() const { return scene_.objects.size(); }

  sim::SettlingBody BodyOf(size_t i) const {
    const SceneObject& object = scene_.objects[i];
    return {&asset_set_.At(object.category).body, object.world_from_object,
            object.welded || held_[i] != 0};
  }

  // Simulates all objects, free, from their poses.
  void Watch() {
    std::vector<sim::SettlingBody> bodies;
    for (size_t i = 0; i < size(); ++i) bodies.push_back(BodyOf(i));
    const std::vector<sim::SettledBody> ends = sim::Settle(bodies, options_.check);
    drift_.assign(size(), 0.0);
    scene_.stable = true;
    scene_.kept_displacement = scene_.drift = 0.0;
    for (size_t i = 0; i < size(); ++i) {
      if (bodies[i].fixed) continue;
      drift_[i] = ends[i].drift;
      scene_.stable = scene_.stable && ends[i].stable;
      double& largest = kept_[i] ? scene_.kept_displacement : scene_.drift;
      largest = std::max(largest, ends[i].drift);
    }
  }

  bool Moves(size_t i) const { return held_[i] == 0 && drift_[i] > options_.check.stable; }

  std::vector<size_t> Disturbed() const {
    std::vector<size_t> disturbed;
    for (size_t i = 0; i < size(); ++i) {
      if (kept_[i] && Moves(i)) disturbed.push_back(i);
    }
    return disturbed;
  }

  bool AnyOtherMoves() const {
    for (size_t i = 0; i < size(); ++i) {
      if (!kept_[i] && Moves(i)) return true;
    }
    return false;
  }

  // Simulates the kept objects alone; those that move are held from now on.
  void HoldUnstable() {
    checked_alone_ = true;
    std::vector<sim::SettlingBody> bodies;
    std::vector<size_t> numbers;
    for (size_t i = 0; i < size(); ++i) {
      if (!kept_[i] && !scene_.objects[i].welded) continue;
      bodies.push_back(BodyOf(i));
      numbers.push_back(i);
    }
    const std::vector<sim::SettledBody> ends = sim::Settle(bodies, options_.check);
    for (size_t i = 0; i < ends.size(); ++i) {
      if (bodies[i].fixed || ends[i].stable) continue;
      held_[numbers[i]] = 1;
      scene_.unstable.push_back(scene_.indices[numbers[i]]);
    }
  }

  // Returns the pairs of objects that are in contact.
  std::vector<std::pair<size_t, size_t>> Contacts() const {
    ConvexBodies bodies;
    for (const SceneObject& object : scene_.objects) {
      bodies.Add(asset_set_.At(object.category).parts, object.world_from_object, object.welded);
    }
    std::vector<NarrowPhasePair> near;
    bodies.Find(std::vector<Eigen::Vector3d>(size(), Eigen::Vector3d::Zero()), kTouching, &near);
    std::vector<std::pair<size_t, size_t>> contacts;
    for (const NarrowPhasePair& pair : near) {
      const auto a = static_cast<size_t>(pair.a), b = static_cast<size_t>(pair.b);
      if (!scene_.objects[a].welded && !scene_.objects[b].welded) contacts.emplace_back(a, b);
    }
    return contacts;
  }

  // Drops the objects that move, and those in contact with a disturbed kept one; returns false if
  // there are none.
  bool DropCulprits() {
    std::vector<char> reached(size(), 0), culprit(size(), 0);
    for (size_t i = 0; i < size(); ++i) culprit[i] = !kept_[i] && Moves(i);
    for (const size_t i : Disturbed()) reached[i] = 1;
    const std::vector<std::pair<size_t, size_t>> contacts = Contacts();
    for (bool grows = true; grows;) {
      grows = false;
      for (const auto& [a, b] : contacts) {
        if (reached[a] == reached[b]) continue;
        reached[a] = reached[b] = 1;
        grows = true;
      }
    }
    for (size_t i = 0; i < size(); ++i) {
      const bool free = !kept_[i] && !scene_.objects[i].welded;
      culprit[i] = culprit[i] || (free && reached[i]);
    }
    const auto count = static_cast<int>(std::count(culprit.begin(), culprit.end(), 1));
    Drop(culprit);
    return count > 0;
  }

  void Drop(const std::vector<char>& gone) {
    size_t to = 0;
    for (size_t i = 0; i < gone.size(); ++i) {
      if (gone[i]) continue;
      scene_.objects[to] = scene_.objects[i];
      scene_.indices[to] = scene_.indices[i];
      kept_[to] = kept_[i];
      held_[to++] = held_[i];
    }
    scene_.dropped += static_cast<int>(gone.size() - to);
    scene_.objects.resize(to);
    scene_.indices.resize(to);
    kept_.resize(to);
    held_.resize(to);
  }

  // Returns the penetrations deeper than `depth`, m, of pairs with an object that is not kept.
  std::vector<NarrowPhasePair> Penetrations(double depth) const {
    ConvexBodies bodies;
    for (size_t i = 0; i < size(); ++i) {
      const SceneObject& object = scene_.objects[i];
      bodies.Add(asset_set_.At(object.category).parts, object.world_from_object,
                 object.welded || kept_[i] != 0);
    }
    std::vector<NarrowPhasePair> near;
    bodies.Find(std::vector<Eigen::Vector3d>(size(), Eigen::Vector3d::Zero()), -depth, &near);
    return near;
  }

  // Drops one object of each pair that penetrates too deeply.
  void DropPenetrating() {
    std::vector<char> gone(size(), 0);
    for (const NarrowPhasePair& pair : Penetrations(options_.feasibility.penetration)) {
      const auto a = static_cast<size_t>(pair.a), b = static_cast<size_t>(pair.b);
      if (gone[a] || gone[b]) continue;
      gone[kept_[b] != 0 || scene_.objects[b].welded ? a : b] = 1;
    }
    Drop(gone);
  }

  const AssetSet& asset_set_;
  const ConstrainedOptions& options_;
  ConstrainedScene& scene_;
  std::vector<char> kept_, held_;
  std::vector<double> drift_;
  bool checked_alone_ = false;
};

}  // namespace

FeasibilityOptions ConstrainedOptions::PlacingOptions() {
  FeasibilityOptions options;
  options.passes = 1;
  options.settling.duration = 0.6;
  const double whole = options.settling.watch;
  options.settling.watch = 0.25;
  options.settling.stable *= options.settling.watch / whole;
  return options;
}

sim::SettlingOptions ConstrainedOptions::FreeCheckOptions() {
  sim::SettlingOptions options;
  options.duration = 0.0;
  return options;
}

ConstrainedScene PlaceAmong(const std::vector<SceneObject>& objects, const std::vector<char>& kept,
                            const AssetSet& asset_set, const ConstrainedOptions& options) {
  if (kept.size() != objects.size()) throw core::Error("each object is kept or not");
  std::vector<SceneObject> held = objects;
  for (size_t i = 0; i < held.size(); ++i) held[i].welded = held[i].welded || kept[i] != 0;
  FeasibilityOptions feasibility = options.feasibility;
  feasibility.min_objects = 0;
  FeasibleScene feasible = MakeFeasible(held, asset_set, feasibility);
  ConstrainedScene scene;
  scene.objects = std::move(feasible.objects);
  scene.indices = std::move(feasible.indices);
  scene.dropped = feasible.dropped;
  scene.drift = feasible.drift;
  scene.penetration = feasible.penetration;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].welded = objects[static_cast<size_t>(scene.indices[i])].welded;
    scene.objects[i].parent = -1;
  }
  return scene;
}

void CheckFree(const std::vector<char>& kept, const AssetSet& asset_set,
               const ConstrainedOptions& options, ConstrainedScene* scene) {
  FreeCheck(kept, asset_set, options, scene).Run();
}

}  // namespace simwright::scene
