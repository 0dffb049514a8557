#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"
#include "library/articulated/generator_options.h"
#include "library/draws.h"
#include "physics_params/physical_parameters.h"

namespace simwright::library {

// A rigid object's visual geometry: closed surfaces (which may intersect) in plain colours, metres,
// z up, standing on z = 0.
struct RigidObject {
  core::TexturedMesh visual;
  // Closed and convex parts that cover `visual`, if the kind defines its own; otherwise empty.
  std::vector<core::TriangleMesh> parts;
  Eigen::Vector3d size;                           // m; the bounds of `visual`
  physics_params::PhysicalParameters parameters;  // as sampled for the category
};

// The input of a generator, and the output of its collision parts if it has its own.
struct RigidDraft {
  Eigen::Vector3d size;  // m
  core::Material look;   // from the sampled material
  Draws draws;
  std::vector<core::TriangleMesh> parts;
  double Draw(double low, double high) { return Uniform(draws, low, high); }
};

void AddParts(const std::vector<core::TriangleMesh>& parts, RigidDraft* draft);

// The symmetry imposed on the sampled length, width and height.
enum class SizeSymmetry {
  kFree,    // each as sampled
  kRound,   // about z: length equals width
  kSquat,   // the same, and not higher than wide
  kBall,    // all three are equal
  kLying,   // about x: width equals height
  kHandled  // round about z, but longer along x by a handle, at least 25 mm
};

struct RigidKind {
  std::string name;      // "mug"
  std::string category;  // row of the knowledge base
  std::string what;      // one line
  SizeSymmetry sides;
  core::TexturedMesh (*make)(RigidDraft*);         // of any size: it is scaled to the draft's
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // m, fixed size of the kind; zero: as sampled
};

// Returns all kinds of objects: vessels, tableware, boxes, fruit and balls, long objects, toys.
const std::vector<RigidKind>& RigidKinds();
// Returns the furniture that supports and contains scenes, each of one size: tables, shelves, a
// chair, a floor.
const std::vector<RigidKind>& FurnitureKinds();
// Returns the kind of that name in either list; null for an unknown one.
const RigidKind* FindRigidKind(const std::string& name);

// The kind families, each in its own file.
std::vector<RigidKind> VesselKinds();
std::vector<RigidKind> TablewareKinds();
std::vector<RigidKind> BoxKinds();
std::vector<RigidKind> RoundKinds();
std::vector<RigidKind> LongObjectKinds();
std::vector<RigidKind> ToyKinds();

// Returns an object of the kind; size and look are sampled from the knowledge base's category by
// the seed, and the same seed gives the same object. Throws core::Error if the base has no such
// category.
RigidObject MakeRigidObject(const RigidKind& kind, std::uint64_t seed);
// Returns the object of given choices and size; the seed determines what they leave open.
RigidObject MakeRigidObject(const RigidKind& kind, const Options& options);

// Returns a material of plain colour.
core::Material Look(const std::string& name, float r, float g, float b);
// Samples one of five colours for a label or for paint.
core::Material Print(RigidDraft* draft);

}  // namespace simwright::library
