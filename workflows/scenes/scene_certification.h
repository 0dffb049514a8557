#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "certificate/certificate.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::workflows {

struct SceneCertificationRequest {
  std::filesystem::path scene;          // any form that ReadSceneSource takes
  std::string scenes;                   // of a dataset: "0,3-5"; empty: the first
  std::string task;                     // "bring the apple to the front"
  std::optional<Eigen::Vector4d> base;  // m and rad: x, y, z and yaw of the robot's base
  int candidates = 96;                  // most grasps per object that are tried with the arm
  bool every = false;                   // certify each object that the task may mean by itself
  bool all_free = false;                // no object stays fixed in the replays
  bool pictures = true;
  std::uint64_t seed = 1;
  std::filesystem::path assets;  // a folder of asset folders; empty: the source's
  // The place of the assets' proved grasps (certificate::ProvedGraspFiles): a folder, or "none";
  // empty: in the assets' folders.
  std::string grasps;
  std::filesystem::path output;
  bool force = false;  // replaces an existing output
};

// The certificate of one scene, or with `every` of one object in it.
struct CertifiedScene {
  std::string name;    // of the source's scene
  std::string target;  // the object that is brought, or that was examined
  int instances = 0;   // objects that the task may mean
  certificate::Certificate certificate;
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();
  std::string trajectory;  // the file, in the output folder; empty: none
  double seconds = 0.0;    // s, of planning, proof and diagnosis
};

struct SceneCertificationReport {
  std::filesystem::path output;
  std::string task;  // as it was read
  std::vector<CertifiedScene> scenes;
  core::Findings findings;
  double seconds = 0.0;  // s, in total

  int SolvableCount() const;
  double MedianSeconds() const;
};

// Certifies a task in each scene of a source (certificate::Certify), in parallel, and writes
// certificate.json, the trajectory of each solvable scene, and certificates.png. Throws core::Error
// for a source, a task or a base that does not fit, an object that no scene has, or an existing
// output.
SceneCertificationReport CertifyScenes(const SceneCertificationRequest& request,
                                       core::Progress* progress);

// Format the report as text for people and as JSON; `timed`: with the seconds that it took, which
// the file leaves out, so that the same input gives the same bytes.
std::string CertificationTable(const SceneCertificationReport& report);
std::string CertificationJson(const SceneCertificationReport& report, bool timed);

}  // namespace simwright::workflows
