#include "workflows/doctor_software.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include "assets/urdf_reader.h"
#include "core/error.h"
#include "core/files.h"
#include "nn/blas_library.h"
#include "physics_params/wordnet.h"
#include "sim/drop_test.h"
#include "sim/mujoco.h"
#include "workflows/priors/models_folder.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr double kBallRadius = 0.03;  // m

core::Finding Good(const std::string& code, const std::string& sentence, double figure) {
  return {code, core::Severity::kInfo, "", sentence, figure};
}

core::Finding Bad(const std::string& code, core::Severity severity, const std::string& sentence,
                  const std::string& remedy) {
  return {code, severity, "", sentence, 0.0, remedy};
}

// Runs an examination and turns an exception into an error finding.
core::Finding Examined(const std::string& code, const std::string& remedy,
                       const std::function<core::Finding()>& examine) {
  try {
    core::Finding finding = examine();
    if (finding.severity != core::Severity::kInfo) finding.remedy = remedy;
    return finding;
  } catch (const core::Cancelled&) {
    throw;
  } catch (const std::exception& error) {
    return Bad(code, core::Severity::kError, error.what(), remedy);
  }
}

core::Finding OnFloor(const std::string& code, const std::string& engine, double lowest) {
  if (std::abs(lowest) < 1e-3) {
    return Good(code, engine + ": a ball dropped from 1 cm comes to rest on the floor", lowest);
  }
  return {code, core::Severity::kError, "", engine + ": a dropped ball does not rest on the floor",
          lowest};
}

core::Finding ExamineBullet() {
  return Examined("bullet", "reinstall libbullet-dev", [] {
    const sim::DropResult drop = sim::DropInBullet(sim::SphereBody(kBallRadius, 0.1));
    return OnFloor("bullet", "Bullet", drop.lowest_point);
  });
}

core::Finding ExamineMujoco() {
  return Examined("mujoco", "install libmujoco-dev of the version the program was built with", [] {
    const core::TemporaryFolder folder;
    const fs::path file = folder.path() / "ball.xml";
    core::WriteFile(file,
                    "<mujoco><worldbody><body name=\"ball\" pos=\"0 0 0.04\"><freejoint/>"
                    "<geom type=\"sphere\" size=\"0.03\" mass=\"0.1\"/></body></worldbody>"
                    "</mujoco>");
    sim::MujocoWorld world(file);
    constexpr double kSeconds = 2.0;
    while (world.time() < kSeconds) world.Step();
    return OnFloor("mujoco", "MuJoCo " + sim::MujocoVersion(),
                   world.Pose(0).translation().z() - kBallRadius);
  });
}

core::Finding ExamineUrdfdom() {
  return Examined("urdfdom", "reinstall liburdfdom-dev", [] {
    const core::TemporaryFolder folder;
    const fs::path file = folder.path() / "box.urdf";
    core::WriteFile(file,
                    "<robot name=\"box\"><link name=\"box\"><collision><geometry>"
                    "<box size=\"0.1 0.2 0.3\"/></geometry></collision></link></robot>");
    const assets::UrdfModel model = assets::ReadUrdf(file);
    const double volume =
        core::Bounds(model.links.at(0).collisions.at(0).mesh).sizes().prod() * 1e3;
    if (std::abs(volume - 6.0) < 1e-6) return Good("urdfdom", "urdfdom reads a URDF", volume);
    return Bad("urdfdom", core::Severity::kError, "urdfdom misreads a URDF", "");
  });
}

core::Finding ExamineWordNet() {
  if (physics_params::WordNet::Installed() != nullptr) {
    return Good("wordnet", "WordNet: names outside the knowledge base are resolved", 1.0);
  }
  return Bad("wordnet", core::Severity::kWarning,
             "WordNet is missing: only the knowledge base's own names are known",
             "install wordnet-base");
}

core::Finding ExamineBlas() {
  const std::string library = nn::BlasLibrary();
  if (library.find("atlas") == std::string::npos && library.find("/blas/") == std::string::npos) {
    return Good("blas", "matrix products by " + (library.empty() ? "libtorch's own" : library),
                1.0);
  }
  return Bad("blas", core::Severity::kWarning,
             "matrix products by " + library + ": networks are several times slower than they need",
             "install libopenblas0-pthread and configure the build again");
}

int CountWeights(const fs::path& folder) {
  int count = 0;
  if (!fs::is_directory(folder)) return 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    count += entry.path().extension() == ".pt" && fs::file_size(entry) > 0;
  }
  return count;
}

core::Finding ExamineWeights() {
  const std::string remedy =
      "set SIMWRIGHT_MODELS to the folder models/ of the source, or train them: `simwright prior "
      "train`, `scene train`, `train`";
  const fs::path models = ModelsFolder();
  if (models.empty() || !fs::is_directory(models)) {
    return Bad("weights", core::Severity::kWarning,
               "no weights: reconstruction uses the silhouette alone, no scene can be sampled and "
               "there are no shipped skills",
               remedy);
  }
  std::string missing;
  const auto miss = [&missing](const std::string& name) {
    missing += (missing.empty() ? "" : ", ") + name;
  };
  for (const char* name : {"shape_prior.pt", "view_prior.pt", "library_prior.pt",
                           "table_detector.pt", "scene_features.pt"}) {
    if (!fs::is_regular_file(models / name)) miss(name);
  }
  const int scenes = CountWeights(models / "scenes"), skills = CountWeights(models / "skills");
  if (scenes == 0) miss("scenes/*.pt");
  if (CountWeights(models / "scenes" / "text") == 0) miss("scenes/text/*.pt");
  if (skills == 0) miss("skills/*.pt");
  if (!missing.empty()) {
    return Bad("weights", core::Severity::kWarning,
               "weights are missing in " + models.string() + ": " + missing, remedy);
  }
  return Good("weights",
              "weights of reconstruction, of " + std::to_string(scenes) + " scene types and of " +
                  std::to_string(skills) + " skills in " + models.string(),
              scenes + skills);
}

}  // namespace

core::Findings ExamineSoftware() {
  return {ExamineBullet(),  ExamineMujoco(), ExamineUrdfdom(),
          ExamineWordNet(), ExamineBlas(),   ExamineWeights()};
}

}  // namespace simwright::workflows
