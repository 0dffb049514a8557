#pragma once

#include "texture/materials/surface_material.h"

namespace simwright::texture {

// The functions of the families. Each takes the material, the part and the point.
using SubstanceFunction = MaterialSample (*)(const SurfaceMaterial&, const PartFrame&,
                                             const MaterialPoint&);
MaterialSample WoodAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample BambooAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample GlazeAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample ClayAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample GlassAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample StoneAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample MarbleAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample ConcreteAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample BrushedMetalAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample PolishedMetalAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample CastMetalAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample PaintAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample PlasticAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample RubberAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample WaxAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample FabricAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample FeltAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample LeatherAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample PaperAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample CardboardAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample CorkAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample SkinAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample CrustAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);
MaterialSample PrintAt(const SurfaceMaterial&, const PartFrame&, const MaterialPoint&);

// Returns the material's colour with its pattern at a point.
Eigen::Vector3f PatternedColor(const SurfaceMaterial& material, const PartFrame& frame,
                               const MaterialPoint& point);

// Returns the point relative to the part, each coordinate in [-1, 1].
Eigen::Vector3f UnitPlace(const PartFrame& frame, const Eigen::Vector3f& position);

// Returns coordinates (m) on the surface of a part: around the vertical and up for round parts,
// else in the plane of the normal's largest component.
Eigen::Vector2f SurfacePlace(const PartFrame& frame, const MaterialPoint& point);

}  // namespace simwright::texture
