#include "assets/sdf_material.h"

#include <tinyxml2.h>

#include "assets/xml_element.h"

namespace simwright::assets {

void SdfMaterial(tinyxml2::XMLPrinter* printer, const Eigen::Vector4f& color,
                 const core::PbrMaterial* pbr, const SdfMaterialFiles& files) {
  Element material(printer, "material");
  const std::string rgba = Numbers({color.x(), color.y(), color.z(), color.w()});
  Leaf(printer, "ambient", rgba);
  Leaf(printer, "diffuse", rgba);
  if (pbr == nullptr) return;
  Element workflows(printer, "pbr");
  Element metal(printer, "metal");
  if (!files.albedo.empty()) Leaf(printer, "albedo_map", files.albedo);
  if (!files.normal.empty()) Leaf(printer, "normal_map", files.normal);
  if (!files.roughness.empty()) {
    Leaf(printer, "roughness_map", files.roughness);
  } else {
    Leaf(printer, "roughness", Number(pbr->roughness));
  }
  if (!files.metalness.empty()) {
    Leaf(printer, "metalness_map", files.metalness);
  } else {
    Leaf(printer, "metalness", Number(pbr->metallic));
  }
}

}  // namespace simwright::assets
