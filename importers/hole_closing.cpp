#include "importers/hole_closing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "geometry/hole_filling.h"
#include "geometry/mesh_validity.h"
#include "geometry/triangle_tree.h"
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
constexpr double kFragmentReach = 0.004;    // of the largest piece's diagonal, from its patches
constexpr double kFragmentArea = 0.02;      // of the largest piece's area
constexpr double kCrumbArea = 1e-4;         // ... of pieces that need not lie on a patch
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
    if (pieces_.empty()) return;
    const auto largest = std::max_element(
        pieces_.begin(), pieces_.end(),
        [](const SurfacePiece& a, const SurfacePiece& b) { return a.area < b.area; });
    const int main = static_cast<int>(largest - pieces_.begin());
    ClosePiece(main);
    const std::vector<char> fragment = FragmentsIn(piece, main);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      if (static_cast<int>(p) != main && !fragment[p]) ClosePiece(static_cast<int>(p));
    }
    fragments = static_cast<int>(std::count(fragment.begin(), fragment.end(), 1));
    if (fragments == 0) return;
    gone_.resize(piece.size());
    for (std::size_t t = 0; t < piece.size(); ++t) {
      gone_[t] = fragment[static_cast<std::size_t>(piece[t])];
    }
  }

  // (faces of the source) 1 for the faces of pieces that lie in a closed hole of the largest piece.
  std::vector<char> FragmentFaces() const {
    std::vector<char> faces(welded_.face_of.size(), 0);
    for (std::size_t f = 0; f < faces.size() && !gone_.empty(); ++f) {
      const int w = welded_.face_of[f];
      faces[f] = w >= 0 && gone_[static_cast<std::size_t>(w)];
    }
    return faces;
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
  int fragments = 0;         // pieces that lie in a closed hole
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

  // Closes the holes of a piece that has no other ones than those that can be closed.
  void ClosePiece(int piece) {
    bool open = false;
    for (const Hole& hole : holes_) {
      if (hole.piece != piece || hole.kind != HoleKind::kOpen) continue;
      open = true;
      widest_open = std::max(widest_open, ShareOf(hole));
    }
    if (open) return;
    CloseFlatHoles(piece);
    for (const Hole& hole : holes_) {
      if (hole.piece != piece || hole.kind != HoleKind::kSmall) continue;
      AddFaces(hole, geometry::FillLoop(welded_.mesh.vertices, hole.loop));
    }
  }

  // Returns 1 for the small open pieces that lie on the patches of the largest one, and for crumbs
  // anywhere on it: what is left of the surface that was torn out there.
  std::vector<char> FragmentsIn(const std::vector<int>& piece, int main) const {
    std::vector<char> fragment(pieces_.size(), 0);
    if (patches.empty()) return fragment;
    core::TriangleMesh closing;
    closing.vertices = welded_.mesh.vertices;
    for (const Patch& patch : patches) closing.triangles.push_back(patch.corners);
    const geometry::TriangleTree tree(closing);
    for (std::size_t t = 0; t < piece.size(); ++t) {
      if (piece[t] == main) closing.triangles.push_back(welded_.mesh.triangles[t]);
    }
    const geometry::TriangleTree whole_tree(closing);
    const SurfacePiece& whole = pieces_[static_cast<std::size_t>(main)];
    const double reach = kFragmentReach * whole.box.diagonal().norm();
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      fragment[p] = static_cast<int>(p) != main && pieces_[p].open_edges > 0 &&
                    pieces_[p].area < kFragmentArea * whole.area;
    }
    for (std::size_t t = 0; t < piece.size(); ++t) {
      char& lies = fragment[static_cast<std::size_t>(piece[t])];
      for (int k = 0; k < 3 && lies; ++k) {
        const bool crumb =
            pieces_[static_cast<std::size_t>(piece[t])].area < kCrumbArea * whole.area;
        lies = (crumb ? whole_tree : tree)
                   .Within(welded_.mesh.vertices[welded_.mesh.triangles[t][k]], reach);
      }
    }
    return fragment;
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
  std::vector<char> gone_;    // (welded faces) of fragments; empty: none
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
    std::vector<char> kept = closer.FragmentFaces();
    for (char& face : kept) face = !face;
    AddPatches(closer, mesh);
    if (closer.fragments > 0) {
      kept.resize(mesh->mesh.triangles.size(), 1);
      KeepFaces(kept, mesh);
      findings->push_back(
          {"mesh-specks", Severity::kWarning, where,
           std::to_string(closer.fragments) + " fragments that lay in a closed hole were removed",
           static_cast<double>(closer.fragments), "look at preview.png"});
    }
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
