#include "workflows/export/asset_export.h"

#include <cstdio>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
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

void ExportRigid(const AssetExportRequest& request, AssetExportReport* report) {
  const assets::Asset asset = assets::ReadAsset(request.asset);
  const assets::PbrLook look = assets::ReadPbrLook(request.asset);
  report->bodies = 1;
  report->shapes = static_cast<int>(asset.parts.size());
  report->mass = asset.inertial.mass;
  Write(assets::UsdOf(asset, look), asset.name, request, report);
}

// Says which motions of a joint UsdPhysics does not express.
void CheckJoint(const assets::ArticulatedAsset& asset, const assets::Joint& joint,
                core::Findings* findings) {
  if (joint.type == assets::JointType::kFloating || joint.type == assets::JointType::kPlanar) {
    findings->push_back({"usd-joint-left-out", core::Severity::kWarning, joint.name,
                         "UsdPhysics has no planar or floating joints; the link moves freely"});
  }
  if (!joint.mimic.has_value()) return;
  if (assets::HasUsdMimic(asset.joints, joint)) {
    findings->push_back({"usd-mimic-of-newton", core::Severity::kInfo, joint.name,
                         "follows a joint by Newton's schema; UsdPhysics has none, so Isaac Sim "
                         "moves it by itself"});
  } else {
    findings->push_back({"usd-mimic-left-out", core::Severity::kWarning, joint.name,
                         "no schema lets it follow a joint of another kind; it moves by itself"});
  }
}

void ExportArticulated(const AssetExportRequest& request, AssetExportReport* report) {
  const assets::ArticulatedAsset asset = assets::ReadArticulatedAsset(request.asset);
  report->bodies = static_cast<int>(asset.links.size());
  for (size_t i = 0; i < asset.links.size(); ++i) {
    const assets::ArticulatedLink& link = asset.links[i];
    report->shapes += static_cast<int>(link.parts.size());
    report->mass += link.inertial.mass;
    const bool is_carried = i > 0 && !asset.joints[i - 1].Moves();
    if (link.inertial.mass > 0.0 || is_carried) continue;
    report->findings.push_back(
        {"usd-massless-link", core::Severity::kWarning, link.name,
         "the link has no mass; readers of USD compute one from its shapes"});
  }
  for (const assets::Joint& joint : asset.joints) {
    report->joints += joint.Moves() ? 1 : 0;
    CheckJoint(asset, joint, &report->findings);
  }
  Write(assets::UsdOf(asset), asset.name, request, report);
}

}  // namespace

AssetExportReport ExportAsset(const AssetExportRequest& request) {
  if (!assets::IsAssetFolder(request.asset)) {
    throw core::Error("holds no asset.json", request.asset.string(),
                      "give a folder made by `simwright lift`, `import` or `library`");
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
