#include "workflows/doctor.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "assets/primitive_meshes.h"
#include "core/parallel.h"
#include "render/forward.h"
#include "workflows/doctor_software.h"

namespace simwright::workflows {
namespace {

std::string DoctorLine(const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

void ExamineMachine(core::Findings* findings) {
  const int threads = core::ThreadCount();
  findings->push_back({"threads", core::Severity::kInfo, "", std::to_string(threads) + " threads",
                       static_cast<double>(threads), "--threads limits them"});
  const double gib = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                     static_cast<double>(sysconf(_SC_PAGE_SIZE)) / std::pow(2.0, 30);
  findings->push_back(
      {"memory", gib < 2.0 ? core::Severity::kWarning : core::Severity::kInfo, "",
       DoctorLine("%.1f GiB; a photo takes up to 1, a mesh of millions of faces 4", gib), gib,
       gib < 2.0 ? "close other programs" : ""});
  std::error_code code;
  const auto space = std::filesystem::space(std::filesystem::temp_directory_path(), code);
  const double free_gib = static_cast<double>(space.available) / std::pow(2.0, 30);
  findings->push_back({"disk",
                       code || free_gib < 0.5 ? core::Severity::kWarning : core::Severity::kInfo,
                       "", DoctorLine("%.1f GiB free for temporary files", free_gib), free_gib,
                       "set TMPDIR to use another folder"});
}

void ExamineRays(core::Findings* findings) {
  core::TexturedMesh ball;
  ball.mesh = assets::SphereMesh(1.0, 100);  // about 10k triangles
  render::Scene scene;
  scene.Add(&ball);
  scene.Commit();
  const core::Camera camera =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 4.0, 0.3, 0.2, 0.6, 512, 512);
  const auto start = std::chrono::steady_clock::now();
  constexpr int kFrames = 4;
  for (int i = 0; i < kFrames; ++i) render::RenderForward(scene, camera);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double rate = kFrames * 512.0 * 512.0 / seconds * 1e-6;
  findings->push_back({"rays", rate < 2.0 ? core::Severity::kWarning : core::Severity::kInfo, "",
                       DoctorLine("%.1f million rays/s, under 2 is slow", rate), rate,
                       rate < 2.0 ? "use a Release build" : ""});
}

}  // namespace

core::Findings Examine() {
  core::Findings findings;
  ExamineMachine(&findings);
  ExamineRays(&findings);
  const core::Findings software = ExamineSoftware();
  findings.insert(findings.end(), software.begin(), software.end());
  return findings;
}

}  // namespace simwright::workflows
