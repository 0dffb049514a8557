#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"
#include "core/random.h"
#include "physics_params/physical_parameters.h"

namespace simwright::library {

// A rigid thing as it is seen: closed surfaces (which may cross) in plain colours, metres, z up,
// standing on z = 0.
struct RigidThing {
  core::TexturedMesh visual;
  // Closed and convex, covering `visual`, where the kind knows its own; else empty.
  std::vector<core::TriangleMesh> parts;
  Eigen::Vector3d size;                           // m; the bounds of `visual`
  physics_params::PhysicalParameters parameters;  // as drawn for the category
};

// What a generator is given, and where it leaves its collision parts if it has its own.
struct RigidDraft {
  Eigen::Vector3d size;  // m
  core::Material look;   // by the material that was drawn
  core::Rng rng;
  std::vector<core::TriangleMesh> parts;
  double Draw(double low, double high) { return core::Uniform(rng, low, high); }
};

void AddParts(const std::vector<core::TriangleMesh>& parts, RigidDraft* draft);

// How the sampled length, width and height are made one thing's.
enum class RigidSides {
  kFree,    // each as sampled
  kRound,   // about z: length and width are one
  kSquat,   // the same, and not as high as wide
  kBall,    // all three are one
  kLying,   // about x: width and height are one
  kHandled  // round about z, but longer along x by a handle, at least 25 mm
};

struct RigidKind {
  std::string name;      // "mug"
  std::string category;  // row of the knowledge base
  std::string what;      // one line
  RigidSides sides;
  core::TexturedMesh (*make)(RigidDraft*);         // of any size: it is stretched to the draft's
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // m, of every one of them; zero: as sampled
};

// All of them: vessels, tableware, boxes, fruit and balls, long things, toys.
const std::vector<RigidKind>& RigidKinds();
// What scenes stand on and in, each of one size: tables, shelves, a chair, a floor.
const std::vector<RigidKind>& FurnitureKinds();
// Of both; null for an unknown one.
const RigidKind* FindRigidKind(const std::string& name);

// The families, each in its own file.
std::vector<RigidKind> VesselKinds();
std::vector<RigidKind> TablewareKinds();
std::vector<RigidKind> BoxKinds();
std::vector<RigidKind> RoundKinds();
std::vector<RigidKind> LongKinds();
std::vector<RigidKind> ToyKinds();

// A thing of the kind; size and look are drawn from the knowledge base's category by the seed, and
// the same seed gives the same thing. Throws core::Error where the base has no such category.
RigidThing MakeRigidThing(const RigidKind& kind, std::uint64_t seed);

// A plain colour.
core::Material Look(const std::string& name, float r, float g, float b);
// The colour of a label or of paint, which come in several: one of five, drawn.
core::Material Print(RigidDraft* draft);

}  // namespace simwright::library
