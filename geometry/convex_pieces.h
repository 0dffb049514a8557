#pragma once

#include <vector>

#include "core/mesh.h"
#include "geometry/convex_decomposition.h"
#include "geometry/hull_fit.h"
#include "geometry/plane_clip.h"

namespace simwright::geometry {

// A piece of the solid on its way to becoming a convex part.
struct Piece {
  core::TriangleMesh mesh;   // closed; empty once pieces were merged
  core::TriangleMesh hull;   // of all of its vertices
  double volume = 0.0;       // m^3, of the piece
  double hull_volume = 0.0;  // m^3
  double concavity = 0.0;    // HullFit's; -1: not measured yet

  double Excess() const { return hull_volume > volume ? hull_volume - volume : 0.0; }
};

// What the steps of one decomposition share.
struct CutContext {
  const DecompositionOptions* options;
  const HullFit* fit;
  double diagonal = 0.0;      // m, of the solid
  double solid_volume = 0.0;  // m^3
  double excess = 0.0;        // m^3, of the whole solid's hull over it
};

// The piece with its hull and volumes; a flat one gets a hull of the options' least thickness.
Piece MakePiece(core::TriangleMesh mesh, const CutContext& context);

// What a cut makes of a piece; empty where it does not cut. Crumbs that no part can stand for are
// left out.
std::vector<Piece> CutPiece(const Piece& piece, const CutPlane& plane, const CutContext& context);

// The plane that serves best (see ConvexDecomposition), already cut. Empty when none helps.
std::vector<Piece> BestCut(const Piece& piece, const CutContext& context);

// Joins neighbours: always where the common hull's concavity is at most `threshold`, and beyond it
// while there are more than `max_parts` (> 0). Hulls alone are kept up to date.
void MergePieces(const CutContext& context, double threshold, int max_parts,
                 std::vector<Piece>* pieces);

}  // namespace simwright::geometry
