#include "texture/materials/surface_material.h"

#include <array>

#include "texture/materials/substances.h"

namespace simwright::texture {
namespace {

// In the order of Substance.
constexpr std::array<SubstanceFunction, 24> kSubstances = {
    WoodAt,    BambooAt,    GlazeAt,        ClayAt,          GlassAt,     StoneAt,
    MarbleAt,  ConcreteAt,  BrushedMetalAt, PolishedMetalAt, CastMetalAt, PaintAt,
    PlasticAt, RubberAt,    WaxAt,          FabricAt,        FeltAt,      LeatherAt,
    PaperAt,   CardboardAt, CorkAt,         SkinAt,          CrustAt,     PrintAt};
static_assert(static_cast<std::size_t>(Substance::kPrint) + 1 == kSubstances.size());

}  // namespace

bool SurfaceMaterial::IsMetal() const {
  return substance == Substance::kBrushedMetal || substance == Substance::kPolishedMetal ||
         substance == Substance::kCastMetal;
}

MaterialSample EvaluateMaterial(const SurfaceMaterial& material, const PartFrame& frame,
                                const MaterialPoint& point) {
  MaterialSample sample =
      kSubstances[static_cast<std::size_t>(material.substance)](material, frame, point);
  sample.color = sample.color.cwiseMax(0.0f).cwiseMin(1.0f);
  sample.roughness = std::min(1.0f, std::max(0.04f, sample.roughness));
  return sample;
}

}  // namespace simwright::texture
