#include <algorithm>

#include "tests/importers/damaged/mesh_damage.h"

namespace simwright::damaged {
namespace {

using Eigen::Vector3d;

void ScaleBy(double factor, Specimen* specimen) {
  for (Vector3d& v : specimen->mesh.vertices) v *= factor;
}

}  // namespace

// OBJ has y up by custom; of a PLY or STL the user says so. GLB is always written with y up.
void TurnYUp(Specimen* specimen, core::Rng*) {
  if (specimen->format == "glb") return;
  specimen->up = specimen->format == "obj" ? 0 : 'y';
  for (Vector3d& v : specimen->mesh.vertices) v = Vector3d(v.x(), v.z(), -v.y()).eval();
}

// In half of the files the user states the unit.
void ToCentimetres(Specimen* specimen, core::Rng* rng) {
  ScaleBy(100.0, specimen);
  if (core::Uniform(*rng) < 0.5) specimen->unit = "cm";
}

void ToInches(Specimen* specimen, core::Rng*) {
  ScaleBy(1.0 / 0.0254, specimen);
  specimen->unit = "in";
}

// Into a box of side 1, as generators do. In half of the files the user states the height.
void NormalizeScale(Specimen* specimen, core::Rng* rng) {
  ScaleBy(1.0 / specimen->sides.maxCoeff(), specimen);
  if (core::Uniform(*rng) < 0.5) {
    specimen->height = specimen->true_height;
  } else {
    specimen->scale_known = false;
  }
}

void MoveAway(Specimen* specimen, core::Rng* rng) {
  const Vector3d offset = 300.0 * specimen->sides.maxCoeff() * core::UniformDirection(*rng);
  for (Vector3d& v : specimen->mesh.vertices) v += offset;
}

void MirrorInNode(Specimen* specimen, core::Rng*) {
  specimen->format = "glb";
  specimen->mirrored_node = true;
}

void ColorVertices(Specimen* specimen, core::Rng*) {
  if (specimen->format != "glb") specimen->format = "ply";
  specimen->vertex_colors = true;
}

void AddPbrTextures(Specimen* specimen, core::Rng*) {
  specimen->format = "glb";
  specimen->pbr_textures = true;
}

const std::vector<Damage>& Damages() {
  static const std::vector<Damage> kDamages = {{"overlapping-part", AddOverlappingPart},
                                               {"inner-wall", AddInnerWall, 1},
                                               {"inner-body", AddInnerBody, 1},
                                               {"staircase", MakeStaircase, 2},
                                               {"heavy", Tessellate, 2},
                                               {"noise", AddNoise},
                                               {"holes", OpenHoles},
                                               {"no-bottom", RemoveBottom},
                                               {"fins", AddFins},
                                               {"double-faces", DoubleFaces},
                                               {"coplanar-faces", DoubleFacesApart},
                                               {"degenerate-faces", AddDegenerateFaces},
                                               {"t-junctions", SplitOneSide, 3},
                                               {"unwelded", SplitVertices, 3},
                                               {"flipped-faces", FlipSomeFaces, 4},
                                               {"inside-out", FlipAllFaces, 4},
                                               {"lost-vertices", LoseVertices, 3},
                                               {"specks", AddSpecks},
                                               {"y-up", TurnYUp},
                                               {"centimetres", ToCentimetres, 5},
                                               {"inches", ToInches, 5},
                                               {"unit-box", NormalizeScale, 5},
                                               {"far-away", MoveAway},
                                               {"mirrored-node", MirrorInNode, 6},
                                               {"vertex-colors", ColorVertices, 7},
                                               {"pbr-textures", AddPbrTextures, 7}};
  return kDamages;
}

}  // namespace simwright::damaged
