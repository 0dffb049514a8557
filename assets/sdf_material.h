#pragma once

#include <string>

#include <Eigen/Core>

#include "core/pbr_look.h"

namespace tinyxml2 {
class XMLPrinter;
}

namespace simwright::assets {

// The files of a material's maps, relative to the SDF; empty where there is none.
struct SdfMaterialFiles {
  std::string albedo, metalness, roughness, normal;
};

// Writes <material> of SDFormat 1.9 with ambient and diffuse colours (RGBA, sRGB) and, if `pbr` is
// not null, the metallic-roughness workflow <pbr><metal>. A factor is written where there is no
// map, since SDFormat's maps replace the factors.
void SdfMaterial(tinyxml2::XMLPrinter* printer, const Eigen::Vector4f& color,
                 const core::PbrMaterial* pbr, const SdfMaterialFiles& files);

}  // namespace simwright::assets
