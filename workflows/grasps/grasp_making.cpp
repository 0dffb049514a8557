#include "workflows/grasps/grasp_making.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/image.h"
#include "core/json.h"
#include "geometry/mesh_validity.h"
#include "manipulation/grasp_proof.h"
#include "manipulation/proved_grasp_set.h"
#include "sim/rigid_body.h"
#include "workflows/grasps/grasp_preview.h"
#include "workflows/grasps/handle_grasps.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSolidFile = "solid.obj";

void RequireAsset(const fs::path& folder) {
  if (assets::IsAssetFolder(folder)) return;
  throw core::Error("holds no asset.json", folder.string(),
                    "give a folder made by `simwright lift`, `import` or `library`");
}

// Returns the files to write and the picture beside the first.
GraspOutput OutputOf(const GraspRequest& request, const fs::path& asset,
                     manipulation::GraspFormat format) {
  GraspOutput output;
  output.format = format;
  output.file = request.output.empty() ? asset / ("grasps" + manipulation::GraspExtension(format))
                                       : request.output;
  output.picture = output.file;
  output.picture.replace_extension(".png");
  // These formats have a file for each link.
  const bool by_link =
      format == manipulation::GraspFormat::kIsaac || format == manipulation::GraspFormat::kAcronym;
  std::vector<std::string> links;
  if (by_link && assets::IsArticulatedAssetFolder(asset)) links = HandleLinks(asset);
  std::vector<fs::path> files = manipulation::GraspFiles(format, output.file, links);
  files.push_back(output.picture);
  for (const fs::path& file : files) {
    if (fs::exists(file) && !request.force) {
      throw core::Error("the file exists", file.string(), "use --force to replace it");
    }
  }
  if (!output.file.parent_path().empty() && !fs::is_directory(output.file.parent_path())) {
    throw core::Error("no such folder", output.file.parent_path().string(), "create it");
  }
  return output;
}

GraspReport GraspsOf(const fs::path& folder, const manipulation::ParallelGripper& gripper,
                     const GraspRequest& request, const GraspOutput& output,
                     core::Progress* progress) {
  GraspReport report;
  const assets::Asset asset = assets::ReadAsset(folder);
  report.asset = asset.name;
  const geometry::MeshValidity solid = geometry::Examine(asset.solid);
  if (!solid.closed) {
    throw core::Error("is not closed: " + std::to_string(solid.open_edges) + " open edges",
                      (folder / kSolidFile).string(), "make the asset again");
  }
  const core::SteadyTime start = core::Now();
  const manipulation::GraspObject object = GraspObjectOf(asset);
  manipulation::GraspProofOptions options;
  options.count = request.count;
  const manipulation::ProvedGrasps proved =
      manipulation::ProveGrasps(object, gripper.model, options, request.seed, progress);
  report.candidates = static_cast<int>(proved.sampling.grasps.size());
  report.set = manipulation::MakeGraspSet(object, kSolidFile, gripper, proved);
  report.seconds = core::SecondsSince(start);
  if (report.set.grasps.empty()) {
    throw core::Error("no grasp: " + proved.WhyNone(gripper.model), asset.name,
                      "use another gripper, or more candidates with a larger --count");
  }
  if (static_cast<int>(report.set.grasps.size()) < request.count) {
    report.findings.push_back({"grasps-fewer", core::Severity::kInfo, asset.name,
                               "has " + std::to_string(report.set.grasps.size()) +
                                   " proved grasps of the " + std::to_string(request.count) +
                                   " wanted",
                               static_cast<double>(report.set.grasps.size())});
  }
  core::WritePng(output.picture, GraspPreview(asset.visual, report.set));
  report.files =
      manipulation::WriteGrasps(report.set, {{"", asset.inertial}}, output.format, output.file);
  report.file = report.files.front();
  report.picture = output.picture;
  return report;
}

}  // namespace

manipulation::GraspObject GraspObjectOf(const assets::Asset& asset) {
  manipulation::GraspObject object;
  object.name = asset.name;
  object.surface = asset.solid;
  object.body = sim::BodyFromAsset(asset);
  object.friction = asset.parameters.friction.min > 0.0
                        ? std::min(asset.parameters.friction.min, asset.friction)
                        : asset.friction;
  return object;
}

std::vector<GraspReport> MakeGrasps(const GraspRequest& request, core::Progress* progress) {
  if (request.assets.empty()) throw core::Error("no asset given", "", "give an asset's folder");
  if (request.assets.size() > 1 && !request.output.empty()) {
    throw core::Error("one output file for several assets", request.output.string(),
                      "leave -o out: the grasps go into each asset's folder");
  }
  const manipulation::GraspFormat format =
      request.format.empty() && request.output.empty()
          ? manipulation::GraspFormat::kJson
          : manipulation::GraspFormatOf(request.format, request.output);
  const manipulation::ParallelGripper gripper = manipulation::ReadGripper(request.gripper);
  std::vector<GraspOutput> outputs;
  for (const fs::path& folder : request.assets) {
    RequireAsset(folder);
    outputs.push_back(OutputOf(request, folder, format));
  }
  std::vector<GraspReport> reports;
  for (size_t i = 0; i < request.assets.size(); ++i) {
    try {
      const bool articulated = assets::IsArticulatedAssetFolder(request.assets[i]);
      const auto make = articulated ? HandleGraspsOf : GraspsOf;
      reports.push_back(make(request.assets[i], gripper, request, outputs[i], progress));
    } catch (const core::Error& error) {
      if (request.assets.size() == 1) throw;
      GraspReport report;
      report.asset = request.assets[i].filename().string();
      report.error = error.what();
      reports.push_back(std::move(report));
    }
  }
  if (!reports.empty()) {
    reports.front().findings.insert(reports.front().findings.begin(), gripper.findings.begin(),
                                    gripper.findings.end());
  }
  return reports;
}

std::string GraspTable(const std::vector<GraspReport>& reports) {
  std::string table;
  for (const GraspReport& report : reports) {
    if (!report.error.empty()) {
      table += "none     " + report.error + "\n";
      continue;
    }
    double quality = 0.0;
    for (const manipulation::Grasp& grasp : report.set.grasps) quality += grasp.quality;
    quality /= static_cast<double>(report.set.grasps.size());
    std::string joints;
    if (!report.set.joint_proofs.empty()) {
      joints = " for " + std::to_string(GrippedJoints(report.set)) + " of " +
               std::to_string(report.set.joint_proofs.size()) + " joints";
    }
    char line[600];
    std::snprintf(line, sizeof(line),
                  "written  %s  %zu grasps%s, quality %.2f, coverage %.0f %%; of %d tried %d held "
                  "in Bullet, %.0f %% of these in MuJoCo  (%.1f s)\n",
                  report.file.string().c_str(), report.set.grasps.size(), joints.c_str(), quality,
                  100.0 * report.set.coverage, report.set.tried, report.set.held_in_bullet,
                  report.set.held_in_bullet > 0
                      ? 100.0 * report.set.held_in_both / report.set.held_in_bullet
                      : 0.0,
                  report.seconds);
    table += line;
  }
  return table;
}

std::string GraspReportsJson(const std::vector<GraspReport>& reports) {
  core::OrderedJson json;
  json["assets"] = core::OrderedJson::array();
  for (const GraspReport& report : reports) {
    core::OrderedJson one = {{"asset", report.asset}};
    if (!report.error.empty()) {
      one["error"] = report.error;
    } else {
      one["file"] = report.file.string();
      one["picture"] = report.picture.string();
      one["grasps"] = report.set.grasps.size();
      one["candidates"] = report.candidates;
      one["friction"] = report.set.friction;
      one["tried"] = report.set.tried;
      one["held_in_bullet"] = report.set.held_in_bullet;
      one["held_in_both"] = report.set.held_in_both;
      one["coverage"] = report.set.coverage;
      for (const fs::path& file : report.files) one["files"].push_back(file.string());
      for (const manipulation::JointProof& proof : report.set.joint_proofs) {
        one["joints"].push_back({{"joint", proof.joint},
                                 {"link", proof.link},
                                 {"grasps", proof.grasps},
                                 {"tried", proof.tried},
                                 {"held_in_bullet", proof.held_in_bullet},
                                 {"held_in_both", proof.held_in_both},
                                 {"reason", proof.reason}});
      }
    }
    json["assets"].push_back(one);
  }
  return core::JsonText(json);
}

}  // namespace simwright::workflows
