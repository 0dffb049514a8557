#include "pipeline/import.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <set>

#include "assets/asset_folder.h"
#include "assets/furniture_catalogue.h"
#include "assets/mesh_import.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "pipeline/catalogue_meshes.h"
#include "pipeline/preview.h"

namespace simwright::pipeline {
namespace fs = std::filesystem;
namespace {

constexpr const char* kStopped = "stopped before it was done";

bool IsCatalogue(const fs::path& path) {
  return path.extension() == ".sh3f";
}

char UpOf(const fs::path& mesh, char wanted) {
  if (wanted != 0) return wanted;
  std::string ending = mesh.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), ::tolower);
  return ending == ".stl" || ending == ".ply" ? 'z' : 'y';
}

// World (z up) from a file whose `up` axis points up; right-handed turns.
Eigen::Matrix3d WorldFromFile(char up) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  if (up == 'y') m << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == 'x') m << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  return m;
}

std::string Unique(std::string name, std::set<std::string>* taken) {
  const std::string base = name;
  for (int i = 2; !taken->insert(name).second; ++i) name = base + "_" + std::to_string(i);
  return name;
}

// What the file's name says of it, else the catch-all.
physics_params::Resolution CategoryOf(const std::string& wanted, const std::string& name) {
  if (!wanted.empty()) return physics_params::RequireCategory(wanted);
  const auto& base = physics_params::KnowledgeBase::Shipped();
  physics_params::Resolution found =
      physics_params::ResolveCategory(name, base, physics_params::WordNet::Installed());
  if (found.category == nullptr) {
    found.category = base.FindCategory("object");
    found.sentence += "; taken for a plastic or wooden object: give --category for a better mass";
  }
  return found;
}

class Importer {
 public:
  Importer(const fs::path& output, const ImportOptions& options)
      : output_(output), options_(options) {}

  // Throws core::Error where the mesh cannot become an asset.
  void Import(const ImportItem& item, const assets::FurnitureCatalogue* catalogue,
              core::Progress* progress, ImportOutcome* outcome) const {
    BuildRequest request;
    request.name = item.name;
    request.seed = options_.seed;
    core::Findings findings;
    core::TexturedMesh visual;
    if (catalogue != nullptr) {
      const assets::CataloguePiece& piece = catalogue->pieces()[static_cast<size_t>(item.piece)];
      visual = ReadCataloguePiece(*catalogue, piece, &findings);
      request.source = item.mesh.filename().string() + ":" + piece.id;
      request.category = CategoryOf(options_.category, piece.name);
    } else {
      visual = ReadInWorld(item.mesh, options_, &findings);
      request.source = item.mesh.filename().string();
      request.category = CategoryOf(options_.category, item.mesh.stem().string());
    }
    BuiltAsset built = BuildAsset(visual, request, progress);
    built.asset.findings.insert(built.asset.findings.begin(), findings.begin(), findings.end());
    const fs::path target = output_ / item.name;
    core::StagedFolder staged(target, options_.force);
    assets::WriteAsset(built.asset, staged.staging());
    core::WritePng(staged.staging() / "preview.png", AssetPreview(built.asset));
    if (options_.check) {
      outcome->check = CheckAsset(staged.staging());
      RequirePassed(*outcome->check, item.name);
    }
    staged.Commit();
    outcome->folder = target;
    outcome->seconds = built.seconds;
  }

 private:
  const fs::path output_;
  const ImportOptions& options_;
};

}  // namespace

core::TexturedMesh ReadInWorld(const fs::path& mesh_path, const ImportOptions& options,
                               core::Findings* findings) {
  core::TexturedMesh mesh = assets::ReadMesh(mesh_path, [&](const std::string& sentence) {
    findings->push_back(
        {"texture", core::Severity::kWarning, mesh_path.filename().string(), sentence, 0.0});
  });
  Eigen::Affine3d world_from_file = Eigen::Affine3d::Identity();
  world_from_file.linear() = options.unit * WorldFromFile(UpOf(mesh_path, options.up));
  core::Transform(world_from_file, &mesh.mesh);
  if (options.height > 0.0) {
    const double height = core::Bounds(mesh.mesh).sizes().z();
    if (!(height > 0.0)) {
      throw core::Error("a flat mesh cannot be scaled to a height", mesh_path.string(),
                        "use --unit instead");
    }
    core::Transform(Eigen::Affine3d(Eigen::Scaling(options.height / height)), &mesh.mesh);
  }
  const double extent = core::Bounds(mesh.mesh).sizes().maxCoeff();
  if (extent < 1e-4 || extent > 100.0) {
    char text[120];
    std::snprintf(text, sizeof(text), "the mesh is %.3g m across", extent);
    throw core::Error(text, mesh_path.string(),
                      "say its unit with --unit mm, cm, in ... or its height with --height");
  }
  return mesh;
}

std::vector<ImportItem> ListImports(const std::vector<fs::path>& inputs,
                                    const ImportOptions& options) {
  std::vector<ImportItem> items;
  std::set<std::string> taken;
  for (const fs::path& input : inputs) {
    if (!fs::exists(input)) throw core::Error("no such file or folder", input.string());
    if (fs::is_directory(input)) {
      std::vector<fs::path> meshes;
      for (const auto& entry : fs::recursive_directory_iterator(input)) {
        if (entry.is_regular_file() && assets::HasMeshEnding(entry.path())) {
          meshes.push_back(entry.path());
        }
      }
      if (meshes.empty()) throw core::Error("holds no meshes", input.string());
      std::sort(meshes.begin(), meshes.end());
      for (const fs::path& mesh : meshes) {
        items.push_back({mesh, -1, Unique(assets::FileSafeName(mesh.stem().string()), &taken)});
      }
    } else if (IsCatalogue(input)) {
      const assets::FurnitureCatalogue catalogue(input);
      int found = 0;
      for (size_t i = 0; i < catalogue.pieces().size(); ++i) {
        const assets::CataloguePiece& piece = catalogue.pieces()[i];
        const bool wanted = options.only.empty() ||
                            piece.name.find(options.only) != std::string::npos ||
                            piece.id.find(options.only) != std::string::npos;
        if (!wanted || (options.limit > 0 && found >= options.limit)) continue;
        ++found;
        const std::string tail = piece.id.substr(piece.id.find('#') + 1);
        items.push_back({input, static_cast<int>(i), Unique(assets::FileSafeName(tail), &taken)});
      }
      if (found == 0) throw core::Error("holds no such piece", input.string());
    } else {
      items.push_back({input, -1, Unique(assets::FileSafeName(input.stem().string()), &taken)});
    }
  }
  return items;
}

std::vector<ImportOutcome> ImportAll(const std::vector<ImportItem>& items, const fs::path& output,
                                     const ImportOptions& options, core::Progress* progress) {
  for (const ImportItem& item : items) {
    if (!options.force && !options.resume && fs::exists(output / item.name)) {
      throw core::Error("the output exists already", (output / item.name).string(),
                        "choose another place, keep what is there with --resume, or replace it "
                        "with --force");
    }
  }
  std::map<fs::path, std::unique_ptr<assets::FurnitureCatalogue>> catalogues;
  for (const ImportItem& item : items) {
    if (item.piece >= 0 && !catalogues.contains(item.mesh)) {
      catalogues[item.mesh] = std::make_unique<assets::FurnitureCatalogue>(item.mesh);
    }
  }
  std::vector<ImportOutcome> outcomes(items.size());
  const Importer importer(output, options);
  const bool many = items.size() > 1;
  if (many) progress->Stage("import", static_cast<int>(items.size()));
  core::Progress silent;
  core::ParallelFor(static_cast<int>(items.size()), [&](int i) {
    const ImportItem& item = items[static_cast<size_t>(i)];
    ImportOutcome& outcome = outcomes[static_cast<size_t>(i)];
    outcome.name = item.name;
    if (options.resume && fs::exists(output / item.name)) {
      outcome.folder = output / item.name;
      outcome.kept = true;
      return;
    }
    const auto start = std::chrono::steady_clock::now();
    try {
      core::CheckCancelled();
      const auto found = catalogues.find(item.mesh);
      importer.Import(item, item.piece >= 0 ? found->second.get() : nullptr,
                      many ? &silent : progress, &outcome);
    } catch (const core::Error& error) {
      outcome.refusal = error.what();
    } catch (const core::Cancelled&) {
      outcome.refusal = kStopped;
    }
    outcome.seconds["total"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (many && !core::CancelRequested()) progress->Advance();
  });
  progress->Finish();
  return outcomes;
}

}  // namespace simwright::pipeline
