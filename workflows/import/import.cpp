#include "workflows/import/import.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <set>

#include "asset_build/articulated_preview.h"
#include "asset_build/preview.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/furniture_catalogue.h"
#include "assets/mesh_format.h"
#include "assets/pbr_look.h"
#include "assets/semantic_model.h"
#include "assets/urdf_meshes.h"
#include "core/error.h"
#include "core/files.h"
#include "core/finding_text.h"
#include "core/free_memory.h"
#include "core/parallel.h"
#include "importers/articulated_import.h"
#include "importers/catalogue_meshes.h"
#include "importers/import_category.h"
#include "importers/rigid_urdf.h"
#include "workflows/import/import_report.h"
#include "workflows/import/mesh_reading.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// The densities of a URDF's bounding box, kg/m3: below that of an empty carton, and that of osmium.
constexpr double kLightest = 1.0, kOsmium = 22600.0;
constexpr double kThinnest = 1e-3;  // m, the minimum side of that box

// The standard error of ln(volume) of an imported mesh: its unit is known, its details are coarse.
constexpr double kImportedVolumeError = 0.05;
constexpr const char* kStopped = "stopped before it was done";

bool IsCatalogue(const fs::path& path) {
  return path.extension() == ".sh3f";
}

bool IsUrdf(const fs::path& path) {
  return path.extension() == ".urdf";
}

std::string Unique(std::string name, std::set<std::string>* taken) {
  const std::string base = name;
  for (int i = 2; !taken->insert(name).second; ++i) name = base + "_" + std::to_string(i);
  return name;
}

// Returns an asset's name: that of its file, or of its folder for PartNet-Mobility, whose URDFs all
// have the same file name.
std::string NameOfFile(const fs::path& file) {
  const bool partnet =
      file.filename() == "mobility.urdf" || file.filename() == assets::kGapartnetUrdf;
  const fs::path named = partnet ? fs::absolute(file).parent_path().filename() : file.stem();
  return assets::FileSafeName(named.string());
}

// Returns the folder outside which no mesh is read: the given one, or the package around it.
fs::path RootOf(const fs::path& urdf, const fs::path& given) {
  const fs::path package = assets::PackageRootOf(urdf);
  const fs::path folder = fs::weakly_canonical(given);
  const fs::path inside = package.lexically_relative(folder);
  return !inside.empty() && *inside.begin() != ".." ? folder : package;
}

// Lists the folder's own URDF, or its meshes and the contents of its subfolders, by name. `top`:
// the folder is an input itself, and a package with several URDFs or only a xacro is an error.
// Meshes beside URDFs, or in a folder beside them, belong to them and are not listed.
void ListFolder(const fs::path& folder, const fs::path& given, std::vector<ImportItem>* items,
                std::set<std::string>* taken) {
  const bool top = folder == given;
  const auto add = [&](const fs::path& urdf, const std::string& name) {
    ImportItem item{urdf, -1, Unique(assets::FileSafeName(name), taken)};
    item.root = RootOf(urdf, given);
    items->push_back(item);
  };
  const std::string name = fs::weakly_canonical(folder).filename().string();
  fs::path urdf = importers::ArticulatedUrdfIn(folder);
  if (urdf.empty() && assets::IsPackage(folder)) {
    const std::vector<fs::path> all = assets::FilesBelow(folder, ".urdf");
    if (all.size() == 1 || top) urdf = assets::UrdfIn(folder);  // throws unless it has one
  }
  if (!urdf.empty()) {
    add(urdf, name);
    return;
  }
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  const bool own_urdfs = std::any_of(entries.begin(), entries.end(), IsUrdf);
  for (const fs::path& entry : entries) {
    if (fs::is_directory(entry) && !fs::is_symlink(entry)) {
      const bool theirs = own_urdfs && assets::FilesBelow(entry, ".urdf").empty();
      if (!theirs) ListFolder(entry, given, items, taken);
    } else if (fs::is_regular_file(entry) && IsUrdf(entry)) {
      add(entry, NameOfFile(entry));
    } else if (fs::is_regular_file(entry) && assets::HasMeshExtension(entry) && !own_urdfs) {
      items->push_back({entry, -1, Unique(NameOfFile(entry), taken)});
    }
  }
}

// Throws for a folder without readable files, naming the files it has instead.
[[noreturn]] void RefuseFolder(const fs::path& folder) {
  std::error_code code;
  for (const auto& entry : fs::recursive_directory_iterator(folder, code)) {
    const std::string format = assets::UnreadMeshFormat(entry.path());
    if (format.empty() || !entry.is_regular_file()) continue;
    throw core::Error("has no readable meshes and no URDF, but '" +
                          entry.path().filename().string() + "' (" + format + ")",
                      folder.string(), "convert it to GLB or OBJ (Blender)");
  }
  if (!assets::FilesBelow(folder, ".xacro").empty()) assets::UrdfIn(folder);  // throws, naming it
  throw core::Error("has no meshes and no URDF", folder.string());
}

void ListCatalogue(const fs::path& input, const ImportOptions& options,
                   std::vector<ImportItem>* items, std::set<std::string>* taken) {
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
    items->push_back({input, static_cast<int>(i), Unique(assets::FileSafeName(tail), taken)});
  }
  if (found == 0) throw core::Error("has no such piece", input.string());
}

// Returns the category hint of a file's location; for a URDF, that of the files beside it.
std::string MeantBy(const ImportItem& item, const assets::SemanticModel* source) {
  if (source == nullptr) return item.mesh.stem().string();
  return source->category.empty() ? source->name : source->category;
}

// Earlier findings are kept, because they may explain the refusal.
void RefuseItem(const core::Error& error, ImportOutcome* outcome) {
  outcome->refusal = error.what();
  outcome->findings.push_back(core::FindingOf(error));
}

// Warns where the solid of a mesh file differs from the surface in its sides or in the thickness
// of its walls, and where a surface that intersects itself is too noisy for exact sides.
void WarnOfSolid(assets::Asset* asset) {
  for (core::Finding& finding : asset->findings) {
    if (finding.code == "solid-sheets" || finding.code == "solid-smoothed") {
      finding.severity = core::Severity::kWarning;
    }
  }
  const Eigen::Vector3d seen = core::Bounds(asset->visual.mesh).sizes();
  const Eigen::Vector3d made = core::Bounds(asset->solid).sizes();
  const double worst = ((made - seen).cwiseAbs().array() / seen.array().max(1e-9)).maxCoeff();
  constexpr double kNoticed = 0.01;
  if (worst <= kNoticed) return;
  char text[160];
  std::snprintf(text, sizeof text, "a side of the solid differs by %.2g %% from that of the mesh",
                100.0 * worst);
  asset->findings.push_back({"solid-size", core::Severity::kWarning, asset->name, text, worst,
                             "close the mesh in a modeller, so that no wall needs a thickness"});
}

class Importer {
 public:
  Importer(const fs::path& output, const ImportOptions& options)
      : output_(output), options_(options) {}

  // Imports one item. Throws core::Error if the mesh or URDF cannot become an asset.
  void Import(const ImportItem& item, const assets::FurnitureCatalogue* catalogue,
              core::Progress* progress, ImportOutcome* outcome) const {
    // A URDF is imported as articulated, or as rigid if no joint moves.
    if (!IsUrdf(item.mesh)) {
      ImportRigid(item, catalogue, nullptr, progress, outcome);
      return;
    }
    assets::SemanticModel source = assets::ReadSemanticModel(item.mesh, {item.root, true});
    outcome->findings = source.model.findings;  // they explain a refusal
    if (importers::HasMovingJoint(source)) {
      ImportJointed(item, std::move(source), progress, outcome);
      return;
    }
    outcome->findings.clear();  // they are added again below
    ImportRigid(item, nullptr, &source, progress, outcome);
  }

 private:
  void ImportJointed(const ImportItem& item, assets::SemanticModel source, core::Progress* progress,
                     ImportOutcome* outcome) const {
    importers::ArticulatedImportOptions options;
    options.name = item.name;
    options.category = options_.category;
    options.height = options_.height;
    options.unit = options_.unit;
    options.unit_stated = options_.unit_stated;
    options.size = options_.size;
    options.stated = options_.stated;
    options.budget = options_.budget;
    options.seed = options_.seed;
    const assets::ArticulatedAsset asset =
        importers::ImportArticulated(std::move(source), options, progress);
    outcome->findings = asset.findings;
    Keep(item, outcome, [&](const fs::path& folder) {
      assets::WriteArticulatedAsset(asset, folder);
      core::WritePng(folder / "preview.png", asset_build::ArticulatedPreview(asset));
    });
  }

  // The item is a piece of `catalogue`, or the URDF `source`, or, without both, a mesh.
  void ImportRigid(const ImportItem& item, const assets::FurnitureCatalogue* catalogue,
                   const assets::SemanticModel* source, core::Progress* progress,
                   ImportOutcome* outcome) const {
    asset_build::BuildRequest request;
    request.name = item.name;
    request.seed = options_.seed;
    core::Findings& findings = outcome->findings;
    findings = options_.earlier;
    ItemMesh mesh;
    core::TexturedMesh& visual = mesh.visual;
    if (catalogue != nullptr) {
      const assets::CataloguePiece& piece = catalogue->pieces()[static_cast<size_t>(item.piece)];
      visual = importers::ReadCataloguePiece(*catalogue, piece, &findings);
      request.source = item.mesh.filename().string() + ":" + piece.id;
      request.category = importers::ImportCategory(options_.category, piece.name);
    } else {
      request.source = options_.source.empty() ? item.mesh.filename().string() : options_.source;
      request.category = importers::ImportCategory(options_.category, MeantBy(item, source));
      mesh = ReadInWorld(item.mesh, source != nullptr ? &source->model : nullptr,
                         *request.category.category, options_, &findings);
    }
    request.stated = options_.stated;
    request.budget = options_.budget;
    request.volume_error = kImportedVolumeError;
    if (source != nullptr) {
      TakeMassOfFile(item, source->model, visual.mesh, &request.stated, &findings);
    }
    asset_build::BuiltAsset built = asset_build::BuildAsset(visual, request, progress);
    built.asset.findings.insert(built.asset.findings.begin(), findings.begin(), findings.end());
    if (catalogue == nullptr && source == nullptr) WarnOfSolid(&built.asset);
    findings = built.asset.findings;
    outcome->seconds = built.seconds;
    Keep(item, outcome, [&](const fs::path& folder) {
      assets::WriteAsset(built.asset, folder);
      core::WritePng(
          folder / "preview.png",
          asset_build::AssetPreview(built.asset, mesh.look.empty() ? nullptr : &mesh.look));
      assets::AddPbrLook(built.asset.visual, mesh.look, built.asset.name, folder);
      if (options_.add_files) options_.add_files(visual, folder);
      if (!mesh.as_read.mesh.empty()) {
        WriteImportReport({mesh.as_read, built.asset, built.seconds}, folder);
      }
    });
  }

  // Uses a rigid URDF's own mass unless a mass or size is stated or the density is impossible.
  void TakeMassOfFile(const ImportItem& item, const assets::UrdfModel& model,
                      const core::TriangleMesh& visual, physics_params::StatedPhysics* stated,
                      core::Findings* findings) const {
    if (stated->mass || stated->density || options_.unit != 1.0 || options_.height > 0.0 ||
        !options_.size.empty()) {
      return;
    }
    const double mass = importers::StatedMass(model);
    if (!(mass > 0.0)) return;
    const double volume = core::Bounds(visual).sizes().cwiseMax(kThinnest).prod();
    const bool possible = mass > kLightest * volume && mass < kOsmium * volume;
    char text[160];
    std::snprintf(text, sizeof(text),
                  possible ? "its mass, %.4g kg, is the file's; its centre and inertia follow "
                             "from the shape"
                           : "no material of its size has the file's mass, %.4g kg: its kind's "
                             "mass is used",
                  mass);
    findings->push_back({"urdf-mass", possible ? core::Severity::kInfo : core::Severity::kWarning,
                         item.mesh.filename().string(), text, mass,
                         possible ? "" : "correct the file's mass, or give --mass"});
    if (possible) stated->mass = mass;
  }

  // Writes the asset and keeps it if it passes its check.
  void Keep(const ImportItem& item, ImportOutcome* outcome,
            const std::function<void(const fs::path&)>& write) const {
    const fs::path target = output_ / item.name;
    core::StagedFolder staged(target, options_.force);
    write(staged.staging());
    if (options_.check) {
      outcome->check = validation::CheckBeforeKeeping(staged.staging(), item.name);
      const core::Findings warnings = outcome->check->Warnings();
      outcome->findings.insert(outcome->findings.end(), warnings.begin(), warnings.end());
    }
    staged.Commit();
    outcome->folder = target;
  }

  const fs::path output_;
  const ImportOptions& options_;
};

}  // namespace

std::vector<ImportItem> ListImports(const std::vector<fs::path>& inputs,
                                    const ImportOptions& options) {
  std::vector<ImportItem> items;
  std::set<std::string> taken;
  for (const fs::path& input : inputs) {
    if (!fs::exists(input)) throw core::Error("no such file or folder", input.string());
    if (fs::is_directory(input)) {
      const size_t before = items.size();
      ListFolder(input, input, &items, &taken);
      if (items.size() == before) RefuseFolder(input);
    } else if (IsCatalogue(input)) {
      ListCatalogue(input, options, &items, &taken);
    } else {
      items.push_back({input, -1, Unique(NameOfFile(input), &taken)});
    }
  }
  return items;
}

std::vector<ImportOutcome> ImportAll(const std::vector<ImportItem>& items, const fs::path& output,
                                     const ImportOptions& options, core::Progress* progress) {
  for (const ImportItem& item : items) {
    if (!options.force && !options.resume && fs::exists(output / item.name)) {
      throw core::Error("the output exists already", (output / item.name).string(),
                        "choose another folder, keep existing ones with --resume, or replace them "
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
    } catch (const validation::CheckFailed& error) {
      RefuseItem(error, &outcome);
      outcome.findings.insert(outcome.findings.end(), error.results().begin(),
                              error.results().end());
    } catch (const core::Error& error) {
      RefuseItem(error, &outcome);
    } catch (const core::Cancelled&) {
      RefuseItem(core::Error(kStopped, item.name, "--resume imports the rest"), &outcome);
    }
    outcome.seconds["total"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    core::ReturnFreeMemory();
    if (many && !core::CancelRequested()) progress->Advance();
  });
  progress->Finish();
  return outcomes;
}

}  // namespace simwright::workflows
