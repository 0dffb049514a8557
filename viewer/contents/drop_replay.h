#pragma once

#include <string>
#include <vector>

#include "sim/rigid_body.h"
#include "viewer/world_document.h"

namespace simwright::viewer {

// A body that is dropped, or a fixed one.
struct DroppedBody {
  std::string name;
  const sim::RigidBody* body = nullptr;  // not null
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();
  bool fixed = false;
};

struct DropOptions {
  double height = 0.05;     // m, by which free bodies are raised
  double seconds = 2.5;     // simulated
  double time_step = 1e-3;  // s
  int steps_per_frame = 20;
  // The drop ends early when no free body moves farther than this (m) in 0.2 s; 0: never early.
  double rest_tolerance = 2e-4;

  bool IsValid(std::string* error) const;
};

// Raises the free bodies, drops them in Bullet onto the fixed ones and the floor z = 0, and records
// their motion. Track i moves body i of `bodies`. The facts name the body that ends farthest from
// its pose in `bodies`. Deterministic. Throws core::Error for invalid options, a free body without
// a mass, and as core::CheckCancelled does.
Timeline DropReplay(const std::vector<DroppedBody>& bodies, const DropOptions& options = {});

// Returns the entry `replay` of a world that DropReplay can animate.
core::OrderedJson DropOffer();

}  // namespace simwright::viewer
