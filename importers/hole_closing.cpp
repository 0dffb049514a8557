#include "importers/hole_closing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "geometry/hole_filling.h"
#include "geometry/mesh_validity.h"
#include "importers/face_selection.h"
#include "importers/welded_surface.h"

namespace simwright::importers {
namespace {

using core::Severity;
using Eigen::Vector3d;
using geometry::BoundaryLoop;
using geometry::LoopShape;

// Shares of the diagonal of the piece.
constexpr double kSmallHole = 0.125;
constexpr double kFlat = 0.02;  // distance from the plane
constexpr double kBottomHeight = 0.03;
constexpr double kClosedWidth = 2e-5;       // of cracks through which no line of sight leads
constexpr double kCrackWidth = 0.0025;      // narrower holes are cracks, of any length
constexpr double kVertical = 0.95;          // cosine of a normal with the vertical
constexpr std::size_t kMostCorners = 4000;  // of a loop that need not be flat
constexpr double kMostTriangles = 0.3;      // holes per face, of a mesh whose faces share edges

enum class HoleKind { kCrack, kSmall, kBottom, kFlatFace, kOpen };

struct Hole {
  BoundaryLoop loop;
  LoopShape shape;
  HoleKind kind = HoleKind::kOpen;
  int piece = 0;
};

class HoleCloser {
 public:
  HoleCloser(const core::TriangleMesh& source, physics_params::Fill fill, bool known)
      : welded_(WeldedSurface(source)), closes_flat_(known && ClosesFlat(fill)) {
    original_ = welded_.mesh.triangles;
    geometry::OrientConsistently(&welded_.mesh);
  }

  // Finds the triangles that close the holes.
  void Close() {
    int count = 0;
    const std::vector<int> piece = geometry::EdgeComponents(welded_.mesh, &count);
    if (count > 1 + kMostTriangles * static_cast<double>(piece.size())) return;
    pieces_ = DescribePieces(welded_.mesh, piece, count);
    FindHoles(piece);
    std::vector<char> open(pieces_.size(), 0);
    for (const Hole& hole : holes_) open[Piece(hole)] |= hole.kind == HoleKind::kOpen;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      if (!open[p]) CloseFlatHoles(static_cast<int>(p));
    }
    for (const Hole& hole : holes_) {
      if (open[Piece(hole)]) {
        if (hole.kind == HoleKind::kOpen) widest_open = std::max(widest_open, ShareOf(hole));
      } else if (hole.kind == HoleKind::kSmall) {
        AddFaces(hole, geometry::FillLoop(welded_.mesh.vertices, hole.loop));
      }
    }
  }

  // (faces of the source) 1 where a face of a closed surface faces inward.
  std::vector<char> TurnedFaces() const {
    std::vector<char> turned(welded_.face_of.size(), 0);
    core::TriangleMesh whole = welded_.mesh;
    for (const Patch& patch : patches) whole.triangles.push_back(patch.corners);
    if (!geometry::OrientConsistently(&whole)) return turned;
    int count = 0;
    const std::vector<int> piece = geometry::EdgeComponents(whole, &count);
    const std::vector<SurfacePiece> pieces = DescribePieces(whole, piece, count);
    for (std::size_t f = 0; f < turned.size(); ++f) {
      const int w = welded_.face_of[f];
      if (w < 0 || pieces[static_cast<std::size_t>(piece[w])].open_edges > 0) continue;
      turned[f] = whole.triangles[w] != original_[w];
    }
    return turned;
  }

  struct Patch {
    Eigen::Vector3i corners;  // vertices of the welded mesh
    int like = 0;             // a welded face beside it
  };
  std::vector<Patch> patches;
  int closed = 0;            // holes
  double widest = 0.0;       // of the closed ones, share of the diagonal
  double widest_open = 0.0;  // of those left open
  const core::TriangleMesh& mesh() const { return welded_.mesh; }
  const std::vector<int>& face_of() const { return welded_.face_of; }

 private:
  static bool ClosesFlat(physics_params::Fill fill) {
    return fill == physics_params::Fill::kSolid || fill == physics_params::Fill::kHollow;
  }
  std::size_t Piece(const Hole& hole) const { return static_cast<std::size_t>(hole.piece); }
  double Diagonal(const Hole& hole) const { return pieces_[Piece(hole)].box.diagonal().norm(); }
  double ShareOf(const Hole& hole) const { return hole.shape.extent / Diagonal(hole); }

  void FindHoles(const std::vector<int>& piece) {
    face_at_.assign(welded_.mesh.vertices.size(), -1);
    for (std::size_t t = 0; t < piece.size(); ++t) {
      for (int k = 0; k < 3; ++k) face_at_[welded_.mesh.triangles[t][k]] = static_cast<int>(t);
    }
    for (BoundaryLoop& loop : geometry::BoundaryLoops(welded_.mesh)) {
      Hole hole;
      hole.piece = piece[face_at_[loop[0]]];
      hole.shape = geometry::ShapeOf(welded_.mesh.vertices, loop);
      hole.loop = std::move(loop);
      hole.kind = KindOf(hole);
      holes_.push_back(std::move(hole));
    }
  }

  HoleKind KindOf(const Hole& hole) const {
    const LoopShape& shape = hole.shape;
    const double diagonal = Diagonal(hole);
    const double width = 2.0 * shape.area / shape.perimeter;
    if (width < kClosedWidth * diagonal) return HoleKind::kCrack;
    const bool narrow = width < kCrackWidth * diagonal;
    const bool small =
        (narrow || shape.extent < kSmallHole * diagonal) && hole.loop.size() <= kMostCorners;
    const bool flat = shape.flatness < kFlat * diagonal;
    const Eigen::AlignedBox3d& box = pieces_[Piece(hole)].box;
    const bool low = shape.center.z() < box.min().z() + kBottomHeight * diagonal;
    if (flat && low && !narrow && std::abs(shape.normal.z()) > kVertical) return HoleKind::kBottom;
    if (small) return HoleKind::kSmall;
    return flat && closes_flat_ ? HoleKind::kFlatFace : HoleKind::kOpen;
  }

  // Closes a piece's bottom, all of whose loops are in one plane, and its other flat holes.
  void CloseFlatHoles(int piece) {
    std::vector<BoundaryLoop> bottom;
    const Hole* any = nullptr;
    for (const Hole& hole : holes_) {
      if (hole.piece != piece) continue;
      if (hole.kind == HoleKind::kBottom) {
        bottom.push_back(hole.loop);
        any = &hole;
      } else if (hole.kind == HoleKind::kFlatFace) {
        CloseTogether({hole.loop}, hole.shape.normal, hole);
      }
    }
    if (any != nullptr) CloseTogether(bottom, -Vector3d::UnitZ(), *any);
  }

  void CloseTogether(const std::vector<BoundaryLoop>& loops, const Vector3d& normal,
                     const Hole& hole) {
    AddFaces(hole, geometry::FillFlatLoops(welded_.mesh.vertices, loops, normal));
  }

  void AddFaces(const Hole& hole, const std::vector<Eigen::Vector3i>& faces) {
    if (faces.empty()) {
      widest_open = std::max(widest_open, ShareOf(hole));
      return;
    }
    for (const Eigen::Vector3i& face : faces) patches.push_back({face, face_at_[face[0]]});
    ++closed;
    widest = std::max(widest, ShareOf(hole));
  }

  geometry::WeldedMesh welded_;
  const bool closes_flat_;
  std::vector<Eigen::Vector3i> original_;  // the welded faces as the file winds them
  std::vector<SurfacePiece> pieces_;
  std::vector<Hole> holes_;
  std::vector<int> face_at_;  // a face at each vertex
};

// Appends the patches, whose vertices are copies: the solid welds them.
void AddPatches(const HoleCloser& closer, core::TexturedMesh* mesh) {
  std::vector<int> source_of(closer.mesh().triangles.size(), 0);
  for (std::size_t f = 0; f < closer.face_of().size(); ++f) {
    if (closer.face_of()[f] >= 0) source_of[closer.face_of()[f]] = static_cast<int>(f);
  }
  std::vector<int> copy(closer.mesh().vertices.size(), -1);
  for (const HoleCloser::Patch& patch : closer.patches) {
    Eigen::Vector3i corners;
    for (int k = 0; k < 3; ++k) {
      int& at = copy[patch.corners[k]];
      if (at < 0) {
        at = static_cast<int>(mesh->mesh.vertices.size());
        mesh->mesh.vertices.push_back(closer.mesh().vertices[patch.corners[k]]);
      }
      corners[k] = at;
    }
    AddFaceLike(source_of[patch.like], corners, mesh);
  }
}

std::string Percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100.0 * share);
  return text;
}

}  // namespace

void CloseHoles(const physics_params::Category& category, const std::string& where,
                core::TexturedMesh* mesh, core::Findings* findings) {
  HoleCloser closer(mesh->mesh, category.fill, category.name != "object");
  closer.Close();
  const std::vector<char> turned = closer.TurnedFaces();
  const auto turns = std::count(turned.begin(), turned.end(), 1);
  if (turns > 0) {
    TurnFaces(turned, mesh);
    findings->push_back({"mesh-faces-turned", Severity::kInfo, where,
                         std::to_string(turns) + " faces of closed surfaces that faced inward "
                                                 "were turned",
                         static_cast<double>(turns)});
  }
  if (closer.closed > 0) {
    AddPatches(closer, mesh);
    findings->push_back({"mesh-holes-closed", Severity::kWarning, where,
                         std::to_string(closer.closed) +
                             (closer.closed == 1 ? " hole was closed; it was "
                                                 : " holes were closed; the widest was ") +
                             Percent(closer.widest) + " of the diagonal across",
                         closer.widest, "look at preview.png; close them in a modeller if wrong"});
  }
  if (closer.widest_open > 0.0) {
    findings->push_back(
        {"mesh-open", Severity::kWarning, where,
         "the surface is open, " + Percent(closer.widest_open) +
             " of the diagonal across, and was taken for a sheet: its walls get a thickness",
         closer.widest_open,
         "where the object is a closed body, close it in a modeller or state its --category"});
  }
}

}  // namespace simwright::importers
