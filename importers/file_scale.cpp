#include "importers/file_scale.h"

#include <cmath>
#include <vector>

#include "asset_build/true_size.h"
#include "physics_params/physical_parameters.h"
#include "physics_params/size_plausibility.h"

namespace simwright::importers {
namespace {

void ScaleMesh(double factor, core::TriangleMesh* mesh) {
  core::Transform(Eigen::Affine3d(Eigen::Scaling(factor)), mesh);
}

}  // namespace

core::Finding ScaleToCategory(const physics_params::Category& category, const FileScale& scale,
                              core::TriangleMesh* mesh) {
  const physics_params::PhysicalParameters sampled = physics_params::SampleParameters(
      category, physics_params::KnowledgeBase::Shipped(), scale.seed);
  ScaleMesh(asset_build::ScaleToSampledSize(sampled, *mesh, scale.place), mesh);
  return asset_build::SizeDrawn(category, asset_build::GroundBoxOf(*mesh).sides, scale.place);
}

void ScaleAbsurdMesh(const physics_params::Category& category, const FileScale& scale,
                     core::TriangleMesh* mesh, core::Findings* findings) {
  const Eigen::Vector3d sides = core::Bounds(*mesh).sizes();
  if (!physics_params::IsAbsurdSize(category, sides)) {
    const double longest = sides.maxCoeff();
    constexpr double kExact = 1e-3;
    if (std::abs(longest - 1.0) > kExact && std::abs(longest - 2.0) > 2.0 * kExact) return;
    findings->push_back({"size-normalized", core::Severity::kWarning, scale.place,
                         "its longest side is " + std::string(longest < 1.5 ? "1" : "2") +
                             " m, the box to which generators scale their meshes: it may not be "
                             "its true size",
                         longest, "give the true size with --height or --size, or --unit m"});
    return;
  }
  const std::string absurd = physics_params::SizeSentence(category, sides);
  const std::vector<std::string> units = physics_params::UnitsThatFit(category, sides / scale.unit);
  if (units.empty()) {
    core::Finding drawn = ScaleToCategory(category, scale, mesh);
    drawn.severity = core::Severity::kWarning;
    drawn.sentence = absurd + "; " + drawn.sentence;
    findings->push_back(drawn);
    return;
  }
  ScaleMesh(physics_params::MetresOfUnit(units[0]) / scale.unit, mesh);
  std::string sentence = absurd + "; the file was taken to be in " + units[0];
  for (std::size_t i = 1; i < units.size(); ++i) {
    sentence += (i == 1 ? ", but could be in " : " or ") + units[i];
  }
  findings->push_back({"unit-guessed", core::Severity::kWarning, scale.place, sentence,
                       physics_params::MetresOfUnit(units[0]),
                       "state the unit with --unit, or the size with --height or --size"});
}

}  // namespace simwright::importers
