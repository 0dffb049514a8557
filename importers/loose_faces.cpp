#include "importers/loose_faces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/mesh_validity.h"
#include "geometry/nested_components.h"
#include "geometry/surface_distance.h"
#include "geometry/triangle_tree.h"
#include "importers/face_selection.h"
#include "importers/welded_surface.h"

namespace simwright::importers {
namespace {

using core::Severity;
using Eigen::Vector3d;

// Lengths are shares of the largest piece's diagonal, areas of its area.
constexpr double kFinArea = 0.005, kFinSize = 0.06;
constexpr double kFlickerDistance = 3e-4, kFlickerArea = 0.5;
constexpr double kTouching = 0.005;  // pieces nearer than this belong together
constexpr double kSpeckSize = 0.04, kSpeckArea = 0.01;
constexpr double kFloatingSize = 0.5;  // larger pieces are objects of their own
constexpr double kMostPieces = 0.5;    // pieces per face, of a mesh whose faces share edges
constexpr int kVisibilityRays = 100000;

double SizeOf(const SurfacePiece& piece) {
  return piece.box.diagonal().norm();
}

std::string Counted(int count, const char* one, const char* several) {
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

bool IsOpaque(const core::TexturedMesh& mesh) {
  return std::all_of(mesh.materials.begin(), mesh.materials.end(),
                     [](const core::Material& one) { return one.base_color.w() >= 1.0f; });
}

// The welded faces of a mesh, some of which are gone.
class LooseFaces {
 public:
  explicit LooseFaces(const core::TexturedMesh& source)
      : welded_(WeldedSurface(source.mesh)),
        opaque_(IsOpaque(source)),
        kept_(welded_.mesh.triangles.size(), 1),
        closed_(welded_.mesh.triangles.size(), 0),
        material_(welded_.mesh.triangles.size(), 0) {
    for (std::size_t f = 0; f < source.triangle_material.size(); ++f) {
      if (welded_.face_of[f] >= 0) material_[welded_.face_of[f]] = source.triangle_material[f];
    }
  }

  void Find() {
    if (!Split(false)) return;
    RemoveFins();
    Split(true);
    RemoveFlicker();
    Split(true);
    RemoveSpecks();
    Split(true);
    RemoveInnerShells();
    MarkClosed();
  }

  // Only finds inner shells.
  void FindShells() {
    if (Split(true)) RemoveInnerShells();
    MarkClosed();
  }

  // Returns 0 for the faces of the source to remove.
  std::vector<char> KeptFaces(const core::TexturedMesh& source) {
    std::vector<char> kept(welded_.face_of.size(), 1);
    std::vector<int> first(welded_.mesh.triangles.size(), -1);  // source face of each welded one
    for (std::size_t f = 0; f < kept.size(); ++f) {
      const int w = welded_.face_of[f];
      if (w < 0) continue;
      kept[f] = kept_[w];
      if (first[w] < 0) first[w] = static_cast<int>(f);
      const bool repeats = kept[f] && first[w] != static_cast<int>(f);
      if (!repeats || !IsRedundant(source, static_cast<int>(f), first[w], w)) continue;
      kept[f] = 0;
      ++flicker;
    }
    return kept;
  }

  int fins = 0, flicker = 0, specks = 0, inner_shells = 0, floating = 0;

 private:
  // Splits the remaining faces into pieces. Returns false if they hardly share edges.
  bool Split(bool whole) {
    rest_.vertices = welded_.mesh.vertices;
    rest_.triangles.clear();
    index_.clear();
    for (std::size_t t = 0; t < kept_.size(); ++t) {
      if (!kept_[t]) continue;
      rest_.triangles.push_back(welded_.mesh.triangles[t]);
      index_.push_back(static_cast<int>(t));
    }
    int count = 0;
    piece_ = whole ? geometry::EdgeComponents(rest_, &count) : ManifoldPieces(rest_, &count);
    pieces_ = DescribePieces(rest_, piece_, count);
    if (pieces_.empty()) return false;
    const auto largest = std::max_element(
        pieces_.begin(), pieces_.end(),
        [](const SurfacePiece& a, const SurfacePiece& b) { return a.area < b.area; });
    main_ = static_cast<std::size_t>(largest - pieces_.begin());
    diagonal_ = SizeOf(*largest);
    return count <= 1 + kMostPieces * static_cast<double>(rest_.triangles.size());
  }

  // Returns true if the source's face `f`, whose corners are those of `first`, adds nothing: it has
  // the same material and side, or its piece is closed, so that its other side is not seen.
  bool IsRedundant(const core::TexturedMesh& source, int f, int first, int welded) const {
    const std::vector<int>& materials = source.triangle_material;
    if (!materials.empty() && materials[f] != materials[first]) return false;
    if (closed_[welded]) return true;
    return core::TriangleAreaVector(source.mesh, f)
               .dot(core::TriangleAreaVector(source.mesh, first)) > 0.0;
  }

  // Marks the welded faces of closed pieces.
  void MarkClosed() {
    closed_.assign(kept_.size(), 0);
    for (std::size_t t = 0; t < index_.size(); ++t) {
      closed_[index_[t]] = pieces_[static_cast<std::size_t>(piece_[t])].open_edges == 0;
    }
  }

  // Removes the pieces for which `gone` is not 0; returns their number.
  int Remove(const std::vector<char>& gone) {
    for (std::size_t t = 0; t < index_.size(); ++t) {
      if (gone[static_cast<std::size_t>(piece_[t])]) kept_[index_[t]] = 0;
    }
    return static_cast<int>(std::count(gone.begin(), gone.end(), 1));
  }

  void RemoveFins() {
    std::vector<char> gone(pieces_.size(), 0);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      const SurfacePiece& one = pieces_[p];
      gone[p] = one.open_edges > 0 && one.shared_edges > 0 && SizeOf(one) < kFinSize * diagonal_ &&
                one.area < kFinArea * pieces_[main_].area;
    }
    fins = Remove(gone);
  }

  // Returns the faces of the pieces for which `chosen` is not 0.
  core::TriangleMesh FacesOf(const std::vector<char>& chosen) const {
    core::TriangleMesh faces;
    faces.vertices = rest_.vertices;
    for (std::size_t t = 0; t < piece_.size(); ++t) {
      if (chosen[static_cast<std::size_t>(piece_[t])])
        faces.triangles.push_back(rest_.triangles[t]);
    }
    return geometry::WithoutUnusedVertices(faces);
  }

  int MaterialOf(std::size_t rest_face) const { return material_[index_[rest_face]]; }

  // Open pieces every face of which lies on the others. Labels have a material of their own.
  void RemoveFlicker() {
    std::vector<char> loose(pieces_.size(), 0), firm(pieces_.size(), 0);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      loose[p] = p != main_ && pieces_[p].open_edges > 0 &&
                 pieces_[p].area < kFlickerArea * pieces_[main_].area;
      firm[p] = !loose[p];
    }
    if (std::count(loose.begin(), loose.end(), 1) == 0) return;
    std::vector<int> firm_material;  // of the faces of the tree
    for (std::size_t t = 0; t < piece_.size(); ++t) {
      if (firm[static_cast<std::size_t>(piece_[t])]) firm_material.push_back(MaterialOf(t));
    }
    const geometry::TriangleTree tree(FacesOf(firm));
    const double reach = kFlickerDistance * diagonal_;
    for (std::size_t t = 0; t < piece_.size(); ++t) {
      char& lies = loose[static_cast<std::size_t>(piece_[t])];
      if (!lies) continue;
      Vector3d middle = Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        const Vector3d& corner = rest_.vertices[rest_.triangles[t][k]];
        middle += corner / 3.0;
        lies = lies && tree.Within(corner, reach);
      }
      if (!lies) continue;
      const int below = tree.Closest(middle, reach).triangle;
      lies = below >= 0 && firm_material[static_cast<std::size_t>(below)] == MaterialOf(t);
    }
    flicker = Remove(loose);
  }

  // Returns for each piece 1 if it touches the largest one, or another that does.
  std::vector<char> TouchingPieces() const {
    std::vector<char> touching(pieces_.size(), 0), fresh(pieces_.size(), 0);
    touching[main_] = fresh[main_] = 1;
    while (std::count(fresh.begin(), fresh.end(), 1) > 0 &&
           std::count(touching.begin(), touching.end(), 0) > 0) {
      const core::TriangleMesh faces = FacesOf(fresh);
      const geometry::TriangleTree tree(faces);
      Eigen::AlignedBox3d near = core::Bounds(faces);
      near.min().array() -= kTouching * diagonal_;
      near.max().array() += kTouching * diagonal_;
      std::fill(fresh.begin(), fresh.end(), 0);
      for (std::size_t t = 0; t < piece_.size(); ++t) {
        const auto p = static_cast<std::size_t>(piece_[t]);
        if (touching[p] || fresh[p] || !near.intersects(pieces_[p].box)) continue;
        for (int k = 0; k < 3 && !fresh[p]; ++k) {
          fresh[p] = tree.Within(rest_.vertices[rest_.triangles[t][k]], kTouching * diagonal_);
        }
      }
      for (std::size_t p = 0; p < fresh.size(); ++p) touching[p] |= fresh[p];
    }
    return touching;
  }

  void RemoveSpecks() {
    if (pieces_.size() == 1) return;
    const std::vector<char> touching = TouchingPieces();
    std::vector<char> gone(pieces_.size(), 0);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      if (touching[p]) continue;
      gone[p] = SizeOf(pieces_[p]) < kSpeckSize * diagonal_ &&
                pieces_[p].area < kSpeckArea * pieces_[main_].area;
      floating += !gone[p] && SizeOf(pieces_[p]) < kFloatingSize * diagonal_;
    }
    specks = Remove(gone);
  }

  // Closed pieces within another that no ray from outside hits.
  void RemoveInnerShells() {
    if (pieces_.size() == 1 || !opaque_) return;
    std::vector<char> hidden(pieces_.size(), 0), closed(pieces_.size(), 0);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      hidden[p] = closed[p] = pieces_[p].open_edges == 0;
    }
    const geometry::TriangleTree tree(rest_);
    for (const Vector3d& hit : geometry::SampleOuterSurface(rest_, kVisibilityRays, 5)) {
      hidden[static_cast<std::size_t>(
          piece_[static_cast<std::size_t>(tree.Closest(hit).triangle)])] = 0;
    }
    core::TriangleMesh shells = FacesOf(closed);
    if (shells.empty() || std::count(hidden.begin(), hidden.end(), 1) == 0) return;
    geometry::OrientConsistently(&shells);
    int count = 0;
    const std::vector<int> shell = geometry::EdgeComponents(shells, &count);
    const std::vector<int> winding = geometry::EnclosingWindingNumbers(shells, shell, count);
    // FacesOf keeps the order of the faces.
    std::size_t next = 0;
    for (std::size_t t = 0; t < piece_.size(); ++t) {
      const auto p = static_cast<std::size_t>(piece_[t]);
      if (!closed[p]) continue;
      if (winding[static_cast<std::size_t>(shell[next++])] < 1) hidden[p] = 0;
    }
    inner_shells = Remove(hidden);
  }

  const geometry::WeldedMesh welded_;
  const bool opaque_;
  std::vector<char> kept_;     // (welded faces)
  std::vector<char> closed_;   // (welded faces) 1 in closed pieces
  std::vector<int> material_;  // (welded faces)

  core::TriangleMesh rest_;  // the kept faces
  std::vector<int> index_;   // of each of them: its welded face
  std::vector<int> piece_;   // and its piece
  std::vector<SurfacePiece> pieces_;
  std::size_t main_ = 0;  // the largest piece
  double diagonal_ = 0.0;
};

void SayInnerShells(const std::string& where, int count, core::Findings* findings) {
  findings->push_back(
      {"mesh-inner-shells", Severity::kInfo, where,
       Counted(count, "closed shell is", "closed shells are") +
           " reached by no line of sight from outside: removed",
       static_cast<double>(count),
       "whether the object is full or hollow follows from its category, --mass and --density"});
}

}  // namespace

void RemoveInnerShells(const std::string& where, core::TexturedMesh* mesh,
                       core::Findings* findings) {
  LooseFaces loose(*mesh);
  loose.FindShells();
  if (loose.inner_shells == 0) return;
  KeepFaces(loose.KeptFaces(*mesh), mesh);
  SayInnerShells(where, loose.inner_shells, findings);
}

void RemoveLooseFaces(const std::string& where, core::TexturedMesh* mesh,
                      core::Findings* findings) {
  LooseFaces loose(*mesh);
  loose.Find();
  const std::vector<char> kept = loose.KeptFaces(*mesh);
  const auto add = [&](const char* code, Severity severity, int count, const std::string& sentence,
                       const char* remedy) {
    if (count == 0) return;
    findings->push_back({code, severity, where, sentence, static_cast<double>(count), remedy});
  };
  add("mesh-fins", Severity::kInfo, loose.fins,
      Counted(loose.fins, "small patch hangs", "small patches hang") +
          " on an edge of the surface: removed",
      "");
  add("mesh-coplanar-faces", Severity::kInfo, loose.flicker,
      Counted(loose.flicker, "face or open piece lies", "faces or open pieces lie") +
          " on the surface a second time: removed",
      "");
  add("mesh-specks", Severity::kWarning, loose.specks,
      Counted(loose.specks, "speck touches nothing: removed", "specks touch nothing: removed"),
      "what belongs to the object can be connected to it in a modeller");
  if (loose.inner_shells > 0) SayInnerShells(where, loose.inner_shells, findings);
  add("mesh-floating-parts", Severity::kWarning, loose.floating,
      Counted(loose.floating, "part floats", "parts float") +
          " free of the rest: kept as part of one rigid body",
      "remove what does not belong to the object in a modeller");
  if (std::count(kept.begin(), kept.end(), 0) > 0) KeepFaces(kept, mesh);
}

}  // namespace simwright::importers
