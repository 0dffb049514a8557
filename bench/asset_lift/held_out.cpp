#include "held_out.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "assets/furniture_catalogue.h"
#include "core/error.h"
#include "core/files.h"
#include "importers/catalogue_meshes.h"
#include "physics_params/category_resolution.h"
#include "workflows/lift/lift.h"

namespace simwright::bench {
namespace fs = std::filesystem;
namespace {

constexpr const char* kTrainingCatalogue = "BlendSwap-CC-0.sh3f";
constexpr const char* kTestCatalogues[] = {"BlendSwap-CC-BY.sh3f", "KatorLegaz.sh3f"};

const physics_params::Category* CategoryOf(const std::string& name) {
  return physics_params::ResolveCategory(name, physics_params::KnowledgeBase::Shipped(),
                                         physics_params::WordNet::Installed())
      .category;
}

// A chroma, or a difference, that is clearly visible.
constexpr float kColorStep = 0.06f;

bool IsColored(const core::TexturedMesh& mesh) {
  if (!mesh.textures.empty()) return true;
  for (const core::Material& material : mesh.materials) {
    const Eigen::Vector3f color = material.base_color.head<3>();
    if (color.maxCoeff() - color.minCoeff() > kColorStep) return true;
    const Eigen::Vector3f first = mesh.materials.front().base_color.head<3>();
    if ((color - first).cwiseAbs().maxCoeff() > kColorStep) return true;
  }
  return false;
}

bool CanBeLifted(const assets::FurnitureCatalogue& catalogue, const assets::CataloguePiece& piece) {
  const double longest = piece.size_m.maxCoeff();
  if (longest < 0.03 || longest > 0.9 || CategoryOf(piece.name) == nullptr) return false;
  try {
    return IsColored(importers::ReadCataloguePiece(catalogue, piece, nullptr));
  } catch (const core::Error&) {
    return false;
  }
}

std::vector<HeldOutPiece> Thinned(std::vector<HeldOutPiece> pieces, int limit) {
  const size_t count = std::min(pieces.size(), static_cast<size_t>(std::max(limit, 0)));
  for (size_t i = 0; i < count; ++i) pieces[i] = pieces[i * pieces.size() / count];
  pieces.resize(count);
  return pieces;
}

}  // namespace

std::vector<HeldOutPiece> ChooseHeldOut(const fs::path& furniture, int limit) {
  std::set<std::string> taken;
  const assets::FurnitureCatalogue training(furniture / kTrainingCatalogue);
  for (const assets::CataloguePiece& piece : training.pieces()) {
    taken.insert(physics_params::NormaliseName(piece.name));
  }
  std::vector<HeldOutPiece> pieces;
  for (const char* file : kTestCatalogues) {
    const assets::FurnitureCatalogue catalogue(furniture / file);
    for (const assets::CataloguePiece& piece : catalogue.pieces()) {
      const std::string name = physics_params::NormaliseName(piece.name);
      if (taken.count(name) > 0 || !CanBeLifted(catalogue, piece)) continue;
      taken.insert(name);
      pieces.push_back({file, piece.id, piece.name});
    }
  }
  return Thinned(std::move(pieces), limit);
}

std::vector<HeldOutPiece> ReadHeldOut(const fs::path& file) {
  std::istringstream lines(core::ReadFile(file, 1 << 20));
  std::vector<HeldOutPiece> pieces;
  std::string line;
  while (std::getline(lines, line)) {
    if (line.empty() || line[0] == '#') continue;
    const size_t first = line.find('\t'), second = line.find('\t', first + 1);
    if (first == std::string::npos || second == std::string::npos || first == 0 ||
        line.find('/') < first) {
      throw core::Error("expected catalogue, id and name, separated by tabs: " + line,
                        file.string(), "--choose writes the list again");
    }
    pieces.push_back({line.substr(0, first), line.substr(first + 1, second - first - 1),
                      line.substr(second + 1)});
  }
  if (pieces.empty()) throw core::Error("it has no objects", file.string());
  return pieces;
}

void WriteHeldOut(const std::vector<HeldOutPiece>& pieces, const fs::path& file) {
  std::string text =
      "# The objects of bench_lift_quality: catalogue, id, name. No training saw one of them.\n"
      "# The rule is in held_out.h; `bench_lift_quality --choose` writes this list.\n";
  for (const HeldOutPiece& piece : pieces) {
    text += piece.catalogue + '\t' + piece.id + '\t' + piece.name + '\n';
  }
  core::WriteFile(file, text);
}

std::vector<CatalogueObject> LoadHeldOut(const std::vector<HeldOutPiece>& pieces,
                                         const fs::path& furniture) {
  std::map<std::string, std::unique_ptr<assets::FurnitureCatalogue>> catalogues;
  std::vector<CatalogueObject> objects;
  for (const HeldOutPiece& wanted : pieces) {
    auto& catalogue = catalogues[wanted.catalogue];
    if (catalogue == nullptr) {
      catalogue = std::make_unique<assets::FurnitureCatalogue>(furniture / wanted.catalogue);
    }
    const auto found = std::find_if(
        catalogue->pieces().begin(), catalogue->pieces().end(),
        [&](const auto& piece) { return piece.id == wanted.id && piece.name == wanted.name; });
    const physics_params::Category* category = CategoryOf(wanted.name);
    if (found == catalogue->pieces().end() || category == nullptr) {
      throw core::Error("no such object, or no category for it: " + wanted.name, wanted.catalogue,
                        "--choose writes the list again");
    }
    objects.push_back({wanted.name, category->name,
                       importers::ReadCataloguePiece(*catalogue, *found, nullptr),
                       workflows::PriorOf(*category)});
  }
  return objects;
}

}  // namespace simwright::bench
