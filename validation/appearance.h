#pragma once

#include <string>

#include "assets/asset.h"
#include "core/finding.h"
#include "validation/asset_photo.h"

// The judgement of an asset's looks. Whether it works is for the other checks.
namespace simwright::validation {

// The grades of a look, best first.
enum class Look { kA, kB, kC, kD };

// Returns "A", "B", "C" or "D".
const char* LookName(Look look);

struct Appearance {
  // One row a measure: code, figure, a sentence with its grade, and a remedy where one would help.
  core::Findings measures;
  Look look = Look::kA;  // the worst grade of a measure
  std::string reasons;   // the measures of that grade, in words; empty for A
  std::string remedy;    // what would raise the grade; empty for A
};

// Judges the looks of an asset that was reconstructed from a photo:
// "outline": the intersection over union of its silhouette from the photo's camera and the photo's;
// "fairness": the typical deviation of the surface's normals (geometry/surface_fairness.h),
// degrees; "flat-faces": of a category whose shape is a box, the distance of the faces' points from
// planes,
//   root mean square of the worst face, percent of the diagonal;
// "symmetry": the mean difference between both sides, percent of the diagonal; of one photo alone;
// "texture": the contrast between neighbouring pixels from the photo's camera, over the photo's;
// "hidden-texture": the same from behind, over that from the front. The last two are left out for
// plain objects.
Appearance JudgeAppearance(const assets::Asset& asset, const AssetPhoto& photo);

}  // namespace simwright::validation
