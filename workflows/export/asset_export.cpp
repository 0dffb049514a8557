#include "workflows/export/asset_export.h"

#include <cstdio>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/glb_asset.h"
#include "assets/usd_asset.h"
#include "assets/usd_tree.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

void Write(const assets::UsdFiles& files, const std::string& name,
           const AssetExportRequest& request, AssetExportReport* report) {
  core::StagedFolder staged(request.output, request.force);
  report->file = name + ".usda";
  report->textures = static_cast<int>(files.images.size());
  assets::WriteUsd(files, staged.staging(), report->file);
  staged.Commit();
}

void WriteGlb(const std::string& glb, const AssetExportRequest& request,
              AssetExportReport* report) {
  if (fs::exists(request.output) && !request.force) {
    throw core::Error("exists already", request.output.string(), "use --force to replace it");
  }
  report->output = request.output.has_parent_path() ? request.output.parent_path() : ".";
  report->file = request.output.filename().string();
  core::WriteFile(request.output, glb);
}

int CountOfTextures(const std::vector<core::Image>& textures, const assets::PbrLook& look) {
  return static_cast<int>(textures.size() + look.images.size());
}

void ExportRigid(const AssetExportRequest& request, AssetExportReport* report) {
  const assets::Asset asset = assets::ReadAsset(request.asset);
  const assets::PbrLook look = assets::ReadPbrLook(request.asset);
  report->bodies = 1;
  report->shapes = static_cast<int>(asset.parts.size());
  report->mass = asset.inertial.mass;
  if (request.format == AssetFormat::kGlb) {
    report->textures = CountOfTextures(asset.visual.textures, look);
    WriteGlb(assets::GlbText(asset, look), request, report);
    return;
  }
  Write(assets::UsdOf(asset, look), asset.name, request, report);
}

void ExportArticulated(const AssetExportRequest& request, AssetExportReport* report) {
  const assets::ArticulatedAsset asset = assets::ReadArticulatedAsset(request.asset);
  report->bodies = static_cast<int>(asset.links.size());
  for (const assets::ArticulatedLink& link : asset.links) {
    report->shapes += static_cast<int>(link.parts.size());
    report->mass += link.inertial.mass;
  }
  for (const assets::Joint& joint : asset.joints) report->joints += joint.Moves() ? 1 : 0;
  if (request.format == AssetFormat::kGlb) {
    for (const assets::ArticulatedLink& link : asset.links) {
      report->textures += CountOfTextures(link.visual.textures, {});
    }
    WriteGlb(assets::GlbText(asset), request, report);
    return;
  }
  report->findings = assets::UsdTreeFindings(*assets::MakeKinematicModel(asset), asset.fixed);
  Write(assets::UsdOf(asset), asset.name, request, report);
}

}  // namespace

AssetExportReport ExportAsset(const AssetExportRequest& request) {
  if (std::filesystem::is_regular_file(request.asset)) {
    throw core::Error("is a file, not the folder of an asset", request.asset.string(),
                      "import it first: simwright import " + request.asset.string() + " -o out");
  }
  if (!assets::IsAssetFolder(request.asset)) {
    throw core::Error("holds no asset.json", request.asset.string(),
                      "give a folder made by `simwright lift`, `import` or `library`");
  }
  if (request.format == AssetFormat::kGlb && request.output.extension() != ".glb") {
    throw core::Error("the file's name must end in .glb", request.output.string());
  }
  AssetExportReport report;
  report.output = request.output;
  if (assets::IsArticulatedAssetFolder(request.asset)) {
    ExportArticulated(request, &report);
  } else {
    ExportRigid(request, &report);
  }
  return report;
}

std::string AssetExportTable(const AssetExportReport& report) {
  char line[256];
  std::snprintf(line, sizeof(line),
                "%s: bodies: %d, joints: %d, convex parts: %d, textures: %d, %.6g kg\n",
                report.file.c_str(), report.bodies, report.joints, report.shapes, report.textures,
                report.mass);
  return line;
}

std::string AssetExportJson(const AssetExportReport& report) {
  return core::JsonText(core::OrderedJson{{"output", report.output.string()},
                                          {"file", report.file},
                                          {"bodies", report.bodies},
                                          {"joints", report.joints},
                                          {"convex_parts", report.shapes},
                                          {"textures", report.textures},
                                          {"mass_kg", report.mass}});
}

}  // namespace simwright::workflows
