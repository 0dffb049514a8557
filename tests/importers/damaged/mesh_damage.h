#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/random.h"

namespace simwright::damaged {

// An object with what is known of it, and how it will be written and imported.
struct Specimen {
  std::string kind;                // of the library, e.g. "mug"
  std::string category;            // as its user states it
  core::TriangleMesh mesh;         // in the file's units and axes
  double volume = 0.0;             // m^3, true
  Eigen::Vector3d sides{0, 0, 0};  // m, true, ascending
  double true_height = 0.0;        // m, along z

  // Facts that the user of the file knows and states. 0 or 1: nothing.
  char up = 0;
  std::string unit;
  double height = 0.0;
  bool scale_known = true;  // false: the sides are compared up to their scale

  // The form of the file.
  std::string format = "obj";  // obj, ply, stl or glb
  bool vertex_colors = false;  // ply or glb
  bool pbr_textures = false;   // glb
  bool mirrored_node = false;  // glb
};

// A kind of damage, as files of generators and downloads have it. Each acts on a closed mesh that
// others may have damaged before, in the order of Damages().
struct Damage {
  std::string name;
  void (*apply)(Specimen*, core::Rng*);
  // Damages of one group exclude each other: they would undo or hide one another. 0: none.
  int group = 0;
};

// Returns all kinds of damage in the order in which they are applied.
const std::vector<Damage>& Damages();

// Splits faces until no edge is longer than `edge` (m). Shared edges are split alike.
core::TriangleMesh Subdivided(const core::TriangleMesh& mesh, double edge);

// The kinds, by what they change. Shape: added or altered parts, with the truth adapted.
void AddOverlappingPart(Specimen* specimen, core::Rng* rng);
void AddInnerWall(Specimen* specimen, core::Rng* rng);
void AddInnerBody(Specimen* specimen, core::Rng* rng);
void MakeStaircase(Specimen* specimen, core::Rng* rng);
void Tessellate(Specimen* specimen, core::Rng* rng);
void AddNoise(Specimen* specimen, core::Rng* rng);
void AddSpecks(Specimen* specimen, core::Rng* rng);
void AddFins(Specimen* specimen, core::Rng* rng);

// Surface: faces that are missing, doubled, turned or cut.
void OpenHoles(Specimen* specimen, core::Rng* rng);
void RemoveBottom(Specimen* specimen, core::Rng* rng);
void DoubleFaces(Specimen* specimen, core::Rng* rng);
void DoubleFacesApart(Specimen* specimen, core::Rng* rng);
void AddDegenerateFaces(Specimen* specimen, core::Rng* rng);
void SplitOneSide(Specimen* specimen, core::Rng* rng);
void FlipSomeFaces(Specimen* specimen, core::Rng* rng);
void FlipAllFaces(Specimen* specimen, core::Rng* rng);
void SplitVertices(Specimen* specimen, core::Rng* rng);
void LoseVertices(Specimen* specimen, core::Rng* rng);

// File: axes, units, place and look.
void TurnYUp(Specimen* specimen, core::Rng* rng);
void ToCentimetres(Specimen* specimen, core::Rng* rng);
void ToInches(Specimen* specimen, core::Rng* rng);
void NormalizeScale(Specimen* specimen, core::Rng* rng);
void MoveAway(Specimen* specimen, core::Rng* rng);
void MirrorInNode(Specimen* specimen, core::Rng* rng);
void ColorVertices(Specimen* specimen, core::Rng* rng);
void AddPbrTextures(Specimen* specimen, core::Rng* rng);

}  // namespace simwright::damaged
