#pragma once

#include <vector>

#include "core/mesh.h"
#include "geometry/convex_decomposition.h"
#include "geometry/hull_fit.h"
#include "geometry/plane_clip.h"

namespace simwright::geometry {

// A piece of the solid during the decomposition into convex parts.
struct Piece {
  core::TriangleMesh mesh;   // closed; empty after the piece was merged
  core::TriangleMesh hull;   // of all of its vertices
  double volume = 0.0;       // m^3, of the piece
  double hull_volume = 0.0;  // m^3
  double concavity = 0.0;    // HullDeviation's; -1: not measured yet
  std::vector<int> cells;    // the finest pieces (numbers) that a merged piece consists of

  double Excess() const { return hull_volume > volume ? hull_volume - volume : 0.0; }
};

// The data shared by the steps of one decomposition.
struct CutContext {
  const DecompositionOptions* options;
  const HullDeviation* fit;
  double diagonal = 0.0;      // m, of the solid
  double solid_volume = 0.0;  // m^3
  double excess = 0.0;        // m^3, excess of the whole solid's hull over the solid
};

// Returns the piece with its hull and volumes. A flat piece gets a hull of the options' minimum
// thickness.
Piece MakePiece(core::TriangleMesh mesh, const CutContext& context);

// Cuts a piece and returns the resulting pieces; empty if the plane does not cut it. Fragments too
// small for a convex part are dropped.
std::vector<Piece> CutPiece(const Piece& piece, const CutPlane& plane, const CutContext& context);

// Returns the pieces from the best cutting plane (see ConvexDecomposition); empty if no cut helps.
std::vector<Piece> BestCut(const Piece& piece, const CutContext& context);

// Cuts a piece along the flat face at a concave edge whose plane leaves the least excess, which
// finds the exact parts of a polyhedral solid; returns nothing for a piece that is curved.
std::vector<Piece> FlatCut(const Piece& piece, const CutContext& context);

// Cuts a piece through its middle across its longest principal axis, or the longest side of its
// AABB if the piece is not elongated; returns nothing for one smaller than a fiftieth of the
// solid's diagonal.
std::vector<Piece> Halved(const Piece& piece, const CutContext& context);

// Returns true if the hulls of two pieces are at most the contact distance apart.
bool AreNeighbours(const Piece& a, const Piece& b, const CutContext& context);

// Returns the common hull of two pieces, its concavity not measured, and without a mesh.
Piece JoinedPiece(const Piece& a, const Piece& b, const CutContext& context);

// Merges pieces that touch, or that see each other through the solid (their hulls may overlap other
// pieces): always if the common hull's concavity is at most `threshold`, and beyond that while
// there are more than `max_parts` (> 0). Only hulls, volumes and cells are kept up to date.
void MergePieces(const CutContext& context, double threshold, int max_parts,
                 std::vector<Piece>* pieces);

// Improves `parts`, groups of `cells` (Piece::cells), at an equal number: moves cells between
// groups, and splits a group while two others are merged, as long as the concavity of the most
// concave one falls, then that of the others in turn, down to the threshold. Cells that are too
// coarse are cut in two, which appends to `cells`. Ends after measuring about `evaluations` hulls.
void RegroupCells(const CutContext& context, int evaluations, std::vector<Piece>* cells,
                  std::vector<Piece>* parts);

}  // namespace simwright::geometry
