#include "assets/pbr_look.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include <tinyxml2.h>

#include "assets/asset_json.h"
#include "assets/obj_file.h"
#include "assets/sdf_material.h"
#include "assets/xml_element.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

std::string MapFileName(const char* role, std::size_t material) {
  char name[48];
  std::snprintf(name, sizeof name, "%s_%03zu.png", role, material);
  return name;
}

double MeanOf(const PbrLook& look, int map) {
  if (map < 0) return 1.0;
  const core::Image& image = look.images[static_cast<std::size_t>(map)];
  double sum = 0.0;
  for (const std::uint8_t value : image.pixels) sum += value;
  return image.pixels.empty() ? 1.0 : sum / (255.0 * static_cast<double>(image.pixels.size()));
}

// Writes the maps and returns the members of the material in asset.json.
core::OrderedJson WriteMaterial(const core::TexturedMesh& visual, const PbrLook& look,
                                std::size_t index, const fs::path& folder) {
  const core::Material& base = visual.materials[index];
  const PbrMaterial& pbr = look.materials[index];
  core::OrderedJson json;
  json["name"] = base.name;
  json["base_color"] = {base.base_color.x(), base.base_color.y(), base.base_color.z(),
                        base.base_color.w()};
  if (base.texture >= 0) {
    json["base_color_map"] =
        TextureFileName(base.texture, static_cast<int>(visual.textures.size()));
  }
  json["metallic"] = pbr.metallic;
  json["roughness"] = pbr.roughness;
  json["normal_scale"] = pbr.normal_scale;
  const auto map = [&](const char* role, int image) {
    if (image < 0) return;
    const std::string file = MapFileName(role, index);
    core::WritePng(folder / file, look.images[static_cast<std::size_t>(image)]);
    json[std::string(role) + "_map"] = file;
  };
  map("metallic", pbr.metallic_map);
  map("roughness", pbr.roughness_map);
  map("normal", pbr.normal_map);
  return json;
}

// Inserts the statements of the n-th material behind its line "newmtl".
void AddToMtl(const PbrLook& look, const fs::path& mtl) {
  constexpr std::uint64_t kMaxMtlBytes = 64ull << 20;
  std::istringstream lines(core::ReadFile(mtl, kMaxMtlBytes));
  std::string text;
  std::size_t next = 0;
  for (std::string line; std::getline(lines, line);) {
    text += line + "\n";
    if (!line.starts_with("newmtl ") || next >= look.materials.size()) continue;
    const PbrMaterial& pbr = look.materials[next];
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "Pm %.6g\nPr %.6g\n", static_cast<double>(pbr.metallic),
                  static_cast<double>(pbr.roughness));
    text += numbers;
    if (pbr.metallic_map >= 0) text += "map_Pm " + MapFileName("metallic", next) + "\n";
    if (pbr.roughness_map >= 0) text += "map_Pr " + MapFileName("roughness", next) + "\n";
    if (pbr.normal_map >= 0) text += "norm " + MapFileName("normal", next) + "\n";
    ++next;
  }
  core::WriteFile(mtl, text);
}

// Opens the XML `file`. Throws core::Error if it is damaged.
void LoadXml(const fs::path& file, tinyxml2::XMLDocument* document) {
  if (document->LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) {
    throw core::Error("is not well-formed XML", file.string(), kAssetRemedy);
  }
}

// Gives the visual geom's material the highlights of the main material.
void AddToMjcf(const core::TexturedMesh& visual, const PbrLook& look, const std::string& name,
               const fs::path& mjcf) {
  tinyxml2::XMLDocument document;
  LoadXml(mjcf, &document);
  tinyxml2::XMLElement* const root = document.FirstChildElement("mujoco");
  tinyxml2::XMLElement* const meshes = root ? root->FirstChildElement("asset") : nullptr;
  tinyxml2::XMLElement* const world = root ? root->FirstChildElement("worldbody") : nullptr;
  tinyxml2::XMLElement* const body = world ? world->FirstChildElement("body") : nullptr;
  tinyxml2::XMLElement* const geom = body ? body->FirstChildElement("geom") : nullptr;
  if (meshes == nullptr || geom == nullptr) {
    throw core::Error("is not the MJCF of an asset", mjcf.string(), kAssetRemedy);
  }
  tinyxml2::XMLElement* material = meshes->FirstChildElement("material");
  if (material == nullptr) {
    const std::string material_name = name + "_material";
    material = document.NewElement("material");
    material->SetAttribute("name", material_name.c_str());
    const Eigen::Vector4f& c =
        visual.materials[static_cast<std::size_t>(MainMaterial(visual))].base_color;
    material->SetAttribute("rgba", Numbers({c.x(), c.y(), c.z(), 1.0}).c_str());
    meshes->InsertFirstChild(material);
    geom->DeleteAttribute("rgba");
    geom->SetAttribute("material", material_name.c_str());
  }
  // A rough surface has no highlight; that of a smooth one is stronger on metal.
  const MeanReflection mean = MeanReflectionOf(look, MainMaterial(visual));
  const double gloss = 1.0 - mean.roughness;
  material->SetAttribute("specular", Numbers({gloss * (0.5 + 0.5 * mean.metallic)}).c_str());
  material->SetAttribute("shininess", Numbers({gloss}).c_str());
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  core::WriteFile(mjcf, printer.CStr());
}

// Gives the SDF's visual the material as <pbr><metal> (SDFormat 1.9). The text is written by a
// printer, because the elements' order is theirs.
void AddToSdf(const core::TexturedMesh& visual, const PbrLook& look, const fs::path& sdf) {
  tinyxml2::XMLDocument document;
  LoadXml(sdf, &document);
  tinyxml2::XMLElement* element = document.FirstChildElement("sdf");
  for (const char* name : {"model", "link", "visual"}) {
    if (element != nullptr) element = element->FirstChildElement(name);
  }
  if (element == nullptr)
    throw core::Error("is not the SDF of an asset", sdf.string(), kAssetRemedy);
  const core::Material& base = visual.materials.front();
  const PbrMaterial& pbr = look.materials.front();
  SdfMaterialFiles files;
  if (base.texture >= 0) {
    files.albedo = TextureFileName(base.texture, static_cast<int>(visual.textures.size()));
  }
  if (pbr.metallic_map >= 0) files.metalness = MapFileName("metallic", 0);
  if (pbr.roughness_map >= 0) files.roughness = MapFileName("roughness", 0);
  if (pbr.normal_map >= 0) files.normal = MapFileName("normal", 0);
  tinyxml2::XMLPrinter material;
  SdfMaterial(&material, base.base_color, &pbr, files);
  tinyxml2::XMLDocument parsed;
  parsed.Parse(material.CStr());
  element->InsertEndChild(parsed.RootElement()->DeepClone(&document));
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  core::WriteFile(sdf, printer.CStr());
}

float Share(const core::JsonField& field) {
  const double value = field.Number();
  if (!(value >= 0.0) || value > 1.0) {
    throw core::Error("a material's factor is outside 0 to 1", "asset.json", kAssetRemedy);
  }
  return static_cast<float>(value);
}

}  // namespace

MeanReflection MeanReflectionOf(const PbrLook& look, int material) {
  if (material < 0 || material >= static_cast<int>(look.materials.size())) return {};
  const PbrMaterial& pbr = look.materials[static_cast<std::size_t>(material)];
  return {pbr.metallic * MeanOf(look, pbr.metallic_map),
          pbr.roughness * MeanOf(look, pbr.roughness_map)};
}

int MainMaterial(const core::TexturedMesh& visual) {
  if (visual.materials.empty() || visual.triangle_material.empty()) return 0;
  std::vector<double> area(visual.materials.size(), 0.0);
  for (std::size_t t = 0; t < visual.triangle_material.size(); ++t) {
    area[static_cast<std::size_t>(visual.triangle_material[t])] +=
        core::TriangleAreaVector(visual.mesh, static_cast<int>(t)).norm();
  }
  return static_cast<int>(std::max_element(area.begin(), area.end()) - area.begin());
}

void AddPbrLook(const core::TexturedMesh& visual, const PbrLook& look, const std::string& name,
                const fs::path& folder) {
  if (look.empty() || visual.materials.empty()) return;
  PbrLook stated = look;
  stated.materials.resize(visual.materials.size());
  const fs::path file = folder / "asset.json";
  core::OrderedJson json =
      core::ParseOrderedJson(core::ReadFile(file, kMaxAssetJsonBytes), file.string(), kAssetRemedy);
  json["materials"] = core::OrderedJson::array();
  for (std::size_t m = 0; m < stated.materials.size(); ++m) {
    json["materials"].push_back(WriteMaterial(visual, stated, m, folder));
  }
  core::WriteFile(file, core::JsonText(json, core::InvalidUtf8::kReplace));
  AddToMtl(stated, folder / "visual.mtl");
  AddToMjcf(visual, stated, name, folder / (name + ".xml"));
  if (stated.materials.size() == 1) AddToSdf(visual, stated, folder / (name + ".sdf"));
}

PbrLook ReadPbrLook(const fs::path& folder) {
  const core::JsonDocument document = ReadAssetJson(folder);
  PbrLook look;
  if (!document.root().Has("materials")) return look;
  for (const core::JsonField& field : document.root()["materials"].Elements()) {
    PbrMaterial pbr;
    pbr.metallic = Share(field["metallic"]);
    pbr.roughness = Share(field["roughness"]);
    pbr.normal_scale = static_cast<float>(field["normal_scale"].Number());
    const auto map = [&](const char* key) {
      if (!field.Has(key)) return -1;
      const std::string file = field[key].Text();
      if (fs::path(file).filename() != file) {
        throw core::Error("a map's name leads out of the folder", document.file(), kAssetRemedy);
      }
      look.images.push_back(core::ReadImage(folder / file));
      return static_cast<int>(look.images.size()) - 1;
    };
    pbr.metallic_map = map("metallic_map");
    pbr.roughness_map = map("roughness_map");
    pbr.normal_map = map("normal_map");
    look.materials.push_back(pbr);
  }
  return look;
}

}  // namespace simwright::assets
