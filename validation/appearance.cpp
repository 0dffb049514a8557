#include "validation/appearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "geometry/surface_fairness.h"
#include "physics_params/knowledge_base.h"
#include "validation/photo_agreement.h"

namespace simwright::validation {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

// The bounds of the grades A, B and C of a measure; beyond the last one the grade is D.
struct LookLimits {
  std::array<double, 3> bounds;
  bool at_least;  // large figures are good
};

Look LookOf(double figure, const LookLimits& limits) {
  for (size_t k = 0; k < limits.bounds.size(); ++k) {
    const bool within = limits.at_least ? figure >= limits.bounds[k] : figure <= limits.bounds[k];
    if (within) return static_cast<Look>(k);
  }
  return Look::kD;
}

class Judgement {
 public:
  explicit Judgement(std::string place) : place_(std::move(place)) {}

  // Adds a measure. `fault`: what the eye sees when the figure is bad.
  void Add(const std::string& code, double figure, const LookLimits& limits,
           const std::string& what, const std::string& fault, const std::string& remedy) {
    const Look look = LookOf(figure, limits);
    core::Finding row{code, core::Severity::kInfo, place_, what + " (" + LookName(look) + ")",
                      figure};
    if (look != Look::kA) row.remedy = remedy;
    appearance_.measures.push_back(row);
    if (look == Look::kA || look < appearance_.look) return;
    if (look > appearance_.look) {
      appearance_.look = look;
      appearance_.reasons.clear();
      appearance_.remedy.clear();
    }
    char text[32];
    std::snprintf(text, sizeof(text), " (%.3g)", figure);
    Append(fault + text, ", ", &appearance_.reasons);
    if (appearance_.remedy.find(remedy) == std::string::npos) {
      Append(remedy, "; ", &appearance_.remedy);
    }
  }

  Appearance Take() { return std::move(appearance_); }

 private:
  static void Append(const std::string& text, const char* separator, std::string* list) {
    *list += (list->empty() ? "" : separator) + text;
  }

  std::string place_;
  Appearance appearance_;
};

// A: like the real object at arm's length; B: small faults; C: faults at first sight; D: wrong. The
// limits were set by eye on reconstructions from one and from many photos (docs/lift.md).
constexpr LookLimits kOutline{{0.97, 0.94, 0.88}, true};
constexpr LookLimits kFairness{{4.0, 7.0, 11.0}, false};
constexpr LookLimits kFlatFaces{{0.3, 0.8, 1.6}, false};
constexpr LookLimits kSymmetry{{1.0, 2.0, 4.0}, false};
constexpr LookLimits kTexture{{0.7, 0.5, 0.3}, true};
constexpr LookLimits kHiddenTexture{{0.5, 0.3, 0.15}, true};

// Returns what would make a surface better.
std::string BetterSurface(const AssetPhoto& photo) {
  return photo.one_of_many ? "take more photos, also from low and from high (docs/capture.md)"
                           : "photograph it from all sides on a printed mat (simwright mat)";
}

void AddShape(const assets::Asset& asset, const AssetPhoto& photo, Judgement* judgement) {
  const core::TriangleMesh& mesh = asset.visual.mesh;
  const double diagonal = core::Bounds(mesh).diagonal().norm();
  judgement->Add("fairness", geometry::MeasureFairness(mesh).typical_deviation * kDegreesPerRadian,
                 kFairness, "degrees between the surface's normals and the mean around them",
                 "the surface is uneven", BetterSurface(photo));
  const physics_params::Category* category =
      physics_params::KnowledgeBase::Shipped().FindCategory(asset.parameters.category);
  if (category != nullptr && category->shape == physics_params::Shape::kBox) {
    double worst = 0.0;
    for (const geometry::FlatFace& face : geometry::FindFlatFaces(mesh)) {
      worst = std::max(worst, face.deviation);
    }
    judgement->Add("flat-faces", 100.0 * worst / diagonal, kFlatFaces,
                   "% of the diagonal between the worst flat face and a plane", "flat faces bulge",
                   BetterSurface(photo));
  }
  // An object that photos show from all sides may truly be crooked.
  if (photo.one_of_many) return;
  judgement->Add("symmetry", 100.0 * geometry::FindMirrorSymmetry(mesh).difference / diagonal,
                 kSymmetry, "% of the diagonal between one side and the other, mirrored",
                 "its two sides differ", "add photos of the side that is hidden");
}

}  // namespace

const char* LookName(Look look) {
  switch (look) {
    case Look::kA:
      return "A";
    case Look::kB:
      return "B";
    case Look::kC:
      return "C";
    default:
      return "D";
  }
}

Appearance JudgeAppearance(const assets::Asset& asset, const AssetPhoto& photo) {
  Judgement judgement(asset.name);
  const PhotoAgreement agreement = CompareWithPhoto(asset.visual, photo);
  judgement.Add("outline", agreement.outline_iou, kOutline,
                "intersection over union of the outline and the photo's",
                "its outline differs from the photo's",
                "check matte.png: give the outline with --mask, or a --segmenter");
  AddShape(asset, photo, &judgement);
  if (agreement.textured) {
    judgement.Add("texture", agreement.texture_contrast, kTexture,
                  "of the photo's contrast between neighbouring pixels, seen from its camera",
                  "its texture is blurred", "use a larger, sharper photo");
    judgement.Add("hidden-texture", agreement.hidden_contrast, kHiddenTexture,
                  "of the front's contrast between neighbouring pixels, seen from behind",
                  "its hidden side is blurred", "add photos of the side that is hidden");
  }
  return judgement.Take();
}

}  // namespace simwright::validation
