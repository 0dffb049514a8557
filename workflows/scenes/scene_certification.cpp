#include "workflows/scenes/scene_certification.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "certificate/scene_bodies.h"
#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "robot/panda_model.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/vocabulary.h"
#include "scene/prompt/object_names.h"
#include "scene/scene_types/scene_types.h"
#include "workflows/scenes/certificate_picture.h"
#include "workflows/scenes/certify_targets.h"
#include "workflows/scenes/certify_task.h"
#include "workflows/scenes/scene_source.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr size_t kPicturedScenes = 4;
constexpr const char* kNoGrasps = "none";  // SceneCertificationRequest::grasps

// Returns the categories that are furniture in any scene type.
std::set<std::string> FurnitureCategories() {
  std::set<std::string> furniture;
  for (const scene::SceneType& type : scene::SceneTypes()) {
    const scene::Vocabulary vocabulary =
        scene::VocabularyOf(type.make(scene::DefaultCategorySizes()));
    for (size_t c = 0; c < vocabulary.categories.size(); ++c) {
      if (vocabulary.welded[c]) furniture.insert(vocabulary.categories[c]);
    }
  }
  return furniture;
}

certificate::ProvedGraspFiles GraspFilesOf(const SceneCertificationRequest& request) {
  certificate::ProvedGraspFiles files;
  if (request.grasps == kNoGrasps) {
    files.use = false;
  } else if (!request.grasps.empty()) {
    files.folder = request.grasps;
    if (!fs::is_directory(files.folder)) {
      throw core::Error("is no folder of grasps", request.grasps,
                        "give a folder with NAME/grasps.json or NAME.json for each asset folder "
                        "NAME, or none");
    }
  }
  return files;
}

// The scenes of a source with their assets.
class CertificationScenes {
 public:
  CertificationScenes(const SceneCertificationRequest& request)
      : source_(ReadSceneSource(request.scene, request.scenes, request.assets)) {
    RefuseOutputOver(request.scene, request.output);
    const std::set<std::string> furniture = FurnitureCategories();
    scene::CategoryFolders folders;
    std::map<fs::path, std::string> keys;  // by asset folder
    for (const SourceScene& one : source_.scenes) {
      std::vector<scene::SceneObject>& objects = objects_.emplace_back();
      std::vector<std::string>& names = names_.emplace_back();
      for (const SourceObject& given : one.objects) {
        std::string& key = keys[given.asset];
        if (key.empty()) key = KeyOf(given, folders);
        folders[key] = given.asset;
        scene::SceneObject object;
        object.category = key;
        object.world_from_object = given.world_from_object;
        object.welded = given.welded.value_or(furniture.count(key) > 0);
        objects.push_back(object);
        names.push_back(given.name);
      }
    }
    assets_ = scene::ReadAssetSet(folders);
    bodies_ = std::make_unique<certificate::SceneBodies>(assets_, GraspFilesOf(request));
  }

  size_t size() const { return source_.scenes.size(); }
  const std::string& Name(size_t i) const { return source_.scenes[i].name; }
  const std::vector<scene::SceneObject>& Objects(size_t i) const { return objects_[i]; }
  const scene::AssetSet& assets() const { return assets_; }
  certificate::PlacedScene Placed(size_t i) const {
    return bodies_->SceneOf(objects_[i], names_[i]);
  }

  // Returns the names of the free objects of all scenes, sorted.
  std::vector<std::string> FreeNames() const {
    std::set<std::string> names;
    for (const auto& objects : objects_) {
      for (const scene::SceneObject& object : objects) {
        if (!object.welded) names.insert(scene::NameOfCategory(object.category));
      }
    }
    return {names.begin(), names.end()};
  }

  // Returns a note on the free objects whose assets have no proved grasps; none if all have.
  core::Findings MissingGrasps() const {
    std::set<std::string> missing;
    int objects = 0, without = 0;
    for (const auto& scene : objects_) {
      for (const scene::SceneObject& object : scene) {
        if (object.welded) continue;
        ++objects;
        if (!bodies_->At(object.category)->grasps.empty()) continue;
        ++without;
        missing.insert(scene::NameOfCategory(object.category));
      }
    }
    if (without == 0) return {};
    std::string names;
    for (const std::string& name : missing) names += (names.empty() ? "" : ", ") + name;
    return {{"certify-sampled-grasps", core::Severity::kInfo, source_.scenes.front().name,
             std::to_string(without) + " of " + std::to_string(objects) +
                 " objects have no proved grasps (" + names + "): the planner samples its own",
             static_cast<double>(without), "make them with `simwright grasps`"}};
  }

  // Returns the free objects of scene `i` that a reference may mean.
  std::vector<int> Meant(size_t i, const scene::ObjectReference& reference) const {
    return MeantObjects(objects_[i], assets_.Sizes(), reference);
  }

 private:
  static std::string KeyOf(const SourceObject& object, const scene::CategoryFolders& folders) {
    const std::string base = object.slot.empty() ? object.asset.filename().string() : object.slot;
    std::string key = base;
    for (int i = 2; folders.count(key) > 0; ++i) key = base + "-" + std::to_string(i);
    return key;
  }

  SceneSource source_;
  std::vector<std::vector<scene::SceneObject>> objects_;  // by scene
  std::vector<std::vector<std::string>> names_;
  scene::AssetSet assets_;
  std::unique_ptr<certificate::SceneBodies> bodies_;
};

void ValidateCertification(const SceneCertificationRequest& request) {
  if (request.candidates < 1 || request.candidates > 10000) {
    throw core::Error("the number of candidates must be 1 to 10000", "--candidates");
  }
  if (request.base && !request.base->allFinite()) {
    throw core::Error("a number of the base is not finite", "--base");
  }
}

// Requires that some scene has the objects of the task.
void RequireObjects(const CertificationScenes& scenes, const scene::ObjectReference& reference,
                    const fs::path& source) {
  for (size_t i = 0; i < scenes.size(); ++i) {
    if (!scenes.Meant(i, reference).empty()) return;
  }
  std::string list;
  for (const std::string& name : scenes.FreeNames()) list += (list.empty() ? "" : ", ") + name;
  const std::string ordinal =
      reference.ordinal > 0 ? scene::OrdinalWord(reference.ordinal) + " " : "";
  throw core::Error("there is no " + ordinal + reference.name, source.string(),
                    "the objects are " + list);
}

certificate::CertificateOptions OptionsOf(const SceneCertificationRequest& request) {
  certificate::CertificateOptions options;
  options.motion.candidates = request.candidates;
  options.motion.seed = request.seed;
  if (request.all_free) options.proof.free_distance = HUGE_VAL;
  return options;
}

// Returns all names that an object may have: of the scenes, and of all scene types.
std::vector<std::string> KnownNames(const CertificationScenes& scenes) {
  std::set<std::string> names;
  for (const std::string& name : scenes.FreeNames()) names.insert(name);
  for (const scene::SceneType& type : scene::SceneTypes()) {
    for (const std::string& name :
         scene::NamesOfVocabulary(scene::VocabularyOf(type.make(scene::DefaultCategorySizes())))) {
      names.insert(name);
    }
  }
  return {names.begin(), names.end()};
}

// Certifies the task in all scenes, one job for each scene or object.
class Certification {
 public:
  Certification(const SceneCertificationRequest& request, core::Progress* progress)
      : request_(request), progress_(progress), scenes_(request) {
    report_.output = request.output;
    task_ = ReadCertifyTask(request.task, KnownNames(scenes_), &report_.findings);
    report_.task = task_.Text();
    if (request.grasps != kNoGrasps) {
      const core::Findings missing = scenes_.MissingGrasps();
      report_.findings.insert(report_.findings.end(), missing.begin(), missing.end());
    }
    RequireObjects(scenes_, task_.object, request.scene);
    if (task_.kind == CertifyKind::kBeside) RequireObjects(scenes_, task_.other, request.scene);
  }

  SceneCertificationReport Run() {
    core::StagedFolder staged(request_.output, request_.force);
    const certificate::Planner planner(robot::Panda(false), {}, request_.seed);
    PlaceRobot(planner);
    const certificate::CertificateOptions options = OptionsOf(request_);
    report_.scenes.resize(jobs_.size());
    progress_->Stage("certifying", static_cast<int>(jobs_.size()));
    core::ParallelFor(static_cast<int>(jobs_.size()), [&](int job) {
      const auto j = static_cast<size_t>(job);
      CertifyJob(planner, options, staged.staging(), jobs_[j], &report_.scenes[j]);
      progress_->Advance();
    });
    if (request_.pictures) WritePictures(staged.staging());
    report_.seconds = core::SecondsSince(start_);
    core::WriteFile(staged.staging() / "certificate.json", CertificationJson(report_, false));
    progress_->Finish();
    staged.Commit();
    return std::move(report_);
  }

 private:
  struct Job {
    size_t scene = 0;
    std::vector<certificate::TargetTask> targets;
  };

  void PlaceRobot(const certificate::Planner& planner) {
    RobotBases bases(planner, request_.base);
    progress_->Stage("placing the robot", static_cast<int>(scenes_.size()));
    for (size_t i = 0; i < scenes_.size(); ++i) {
      placed_.push_back(scenes_.Placed(i));
      auto targets =
          CertifyTargets(task_, scenes_.Objects(i), scenes_.assets().Sizes(), placed_[i], &bases);
      if (request_.every) {
        for (certificate::TargetTask& target : targets) jobs_.push_back({i, {std::move(target)}});
      } else {
        jobs_.push_back({i, std::move(targets)});
      }
      progress_->Advance();
    }
  }

  void CertifyJob(const certificate::Planner& planner,
                  const certificate::CertificateOptions& options, const fs::path& folder,
                  const Job& job, CertifiedScene* one) const {
    one->name = scenes_.Name(job.scene);
    one->instances = static_cast<int>(job.targets.size());
    if (job.targets.empty()) {
      one->certificate.reason = "the scene has no such object";
      return;
    }
    const auto began = std::chrono::steady_clock::now();
    const certificate::PlacedScene& scene = placed_[job.scene];
    fs::path file = one->name;
    if (request_.every) {
      file /= scene.bodies[static_cast<size_t>(job.targets.front().target)].name;
    }
    fs::create_directories(folder / file);
    one->certificate =
        certificate::Certify(planner, scene, certificate::EasiestFirst(planner, scene, job.targets),
                             options, folder / file / "trajectory.json");
    one->seconds = core::SecondsSince(began);
    const int target = one->certificate.target;
    one->target = scene.bodies[static_cast<size_t>(target)].name;
    for (const certificate::TargetTask& given : job.targets) {
      if (given.target == target) one->world_from_robot = given.world_from_robot;
    }
    if (one->certificate.solvable()) {
      one->trajectory = (file / "trajectory.json").string();
    } else {
      fs::remove_all(folder / file);
    }
  }

  void WritePictures(const fs::path& folder) const {
    std::vector<CertificateView> views;
    for (size_t j = 0; j < jobs_.size() && views.size() < kPicturedScenes; ++j) {
      const CertifiedScene& one = report_.scenes[j];
      if (!one.certificate.solvable()) continue;
      views.push_back(
          {&scenes_.Objects(jobs_[j].scene), &one.certificate.proof.moments, one.world_from_robot});
    }
    progress_->Stage("rendering", static_cast<int>(views.size()));
    WriteCertificateSheet(views, scenes_.assets(), robot::Panda(false), folder / "certificates.png",
                          progress_);
  }

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const SceneCertificationRequest& request_;
  core::Progress* progress_;
  CertificationScenes scenes_;
  CertifyTask task_;
  SceneCertificationReport report_;
  std::vector<certificate::PlacedScene> placed_;  // by scene
  std::vector<Job> jobs_;
};

}  // namespace

SceneCertificationReport CertifyScenes(const SceneCertificationRequest& request,
                                       core::Progress* progress) {
  ValidateCertification(request);
  return Certification(request, progress).Run();
}

}  // namespace simwright::workflows
