#include "workflows/grasps/handle_grasps.h"

#include <algorithm>
#include <map>
#include <set>

#include "assets/articulated_folder.h"
#include "assets/semantic_model.h"
#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/image.h"
#include "manipulation/grasp_proof.h"
#include "manipulation/handle.h"
#include "manipulation/proved_grasp_set.h"
#include "workflows/grasps/grasp_preview.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// An articulated asset with its handles.
struct HandleAsset {
  assets::ArticulatedAsset asset;
  std::string urdf;  // its file name
  std::vector<manipulation::Handle> handles;
};

HandleAsset ReadHandleAsset(const fs::path& folder) {
  HandleAsset read;
  read.asset = assets::ReadArticulatedAsset(folder);
  const assets::SemanticModel model = assets::ReadSemanticModel(folder);
  read.urdf = model.urdf.filename().string();
  read.handles =
      manipulation::HandlesOf(read.asset.name, model, read.asset.parameters.friction.min);
  return read;
}

std::vector<manipulation::ProvedGrasps> ProveHandles(const HandleAsset& asset,
                                                     const manipulation::ParallelGripper& gripper,
                                                     const GraspRequest& request,
                                                     core::Progress* progress) {
  manipulation::GraspProofOptions options;
  const auto gripped = std::count_if(asset.handles.begin(), asset.handles.end(),
                                     [](const auto& handle) { return handle.reason.empty(); });
  options.count = std::max(1, request.count / std::max(1, static_cast<int>(gripped)));
  std::vector<manipulation::ProvedGrasps> proofs;
  for (const manipulation::Handle& handle : asset.handles) {
    proofs.emplace_back();
    if (!handle.reason.empty()) continue;
    proofs.back() =
        manipulation::ProveGrasps(handle.object, gripper.model, options, request.seed, progress);
  }
  return proofs;
}

std::map<std::string, GraspedLinkView> LinkViews(const HandleAsset& asset) {
  std::map<std::string, GraspedLinkView> views;
  for (const manipulation::Handle& handle : asset.handles) {
    if (!handle.object.part) continue;
    for (const assets::ArticulatedLink& link : asset.asset.links) {
      if (link.name != handle.link) continue;
      views[link.name] = {link.visual, handle.object.support_from_object};
    }
  }
  return views;
}

std::map<std::string, double> RestOf(const HandleAsset& asset) {
  std::map<std::string, double> positions;
  for (const manipulation::Handle& handle : asset.handles) {
    if (handle.object.part) positions[handle.joint] = handle.object.part->rest;
  }
  return positions;
}

manipulation::GraspInertials InertialsOf(const HandleAsset& asset) {
  manipulation::GraspInertials inertials;
  for (const assets::ArticulatedLink& link : asset.asset.links) {
    inertials[link.name] = link.inertial;
  }
  return inertials;
}

// Reports the joints without grasps; throws if none has any.
void ReportJoints(GraspReport* report) {
  std::string reasons;
  for (const manipulation::JointProof& proof : report->set.joint_proofs) {
    if (proof.grasps > 0) continue;
    const std::string sentence =
        "no hand moves " + proof.joint + " by " + proof.link + ": " + proof.reason;
    reasons += (reasons.empty() ? "" : "; ") + sentence;
    report->findings.push_back(
        {"grasps-no-handle", core::Severity::kInfo, report->asset, sentence});
  }
  if (report->set.grasps.empty()) {
    throw core::Error("no grasp: " + reasons, report->asset, "use another gripper");
  }
}

}  // namespace

std::vector<std::string> HandleLinks(const fs::path& folder) {
  std::set<std::string> links;
  for (const manipulation::Handle& handle : ReadHandleAsset(folder).handles) {
    links.insert(handle.link);
  }
  return {links.begin(), links.end()};
}

GraspReport HandleGraspsOf(const fs::path& folder, const manipulation::ParallelGripper& gripper,
                           const GraspRequest& request, const GraspOutput& output,
                           core::Progress* progress) {
  const core::SteadyTime start = core::Now();
  GraspReport report;
  const HandleAsset asset = ReadHandleAsset(folder);
  report.asset = asset.asset.name;
  if (asset.handles.empty()) {
    throw core::Error("no grasp: it has no movable joint", report.asset);
  }
  const std::vector<manipulation::ProvedGrasps> proofs =
      ProveHandles(asset, gripper, request, progress);
  for (const manipulation::ProvedGrasps& proof : proofs) {
    report.candidates += static_cast<int>(proof.sampling.grasps.size());
  }
  report.set = manipulation::MakeGraspSet(report.asset, asset.urdf, gripper, asset.handles, proofs);
  report.seconds = core::SecondsSince(start);
  ReportJoints(&report);
  core::WritePng(output.picture, GraspPreview(assets::VisualAtPositions(asset.asset, RestOf(asset)),
                                              report.set, LinkViews(asset)));
  report.files =
      manipulation::WriteGrasps(report.set, InertialsOf(asset), output.format, output.file);
  report.file = report.files.front();
  report.picture = output.picture;
  return report;
}

int GrippedJoints(const manipulation::GraspSet& set) {
  return static_cast<int>(std::count_if(set.joint_proofs.begin(), set.joint_proofs.end(),
                                        [](const auto& proof) { return proof.grasps > 0; }));
}

}  // namespace simwright::workflows
