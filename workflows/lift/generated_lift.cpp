#include "workflows/lift/generated_lift.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "assets/mesh_archive.h"
#include "core/camera.h"
#include "core/error.h"
#include "core/files.h"
#include "render/forward.h"
#include "workflows/generator/generator_client.h"
#include "workflows/generator/generator_command.h"
#include "workflows/import/import.h"
#include "workflows/lift/cut_out.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// The photo's object as the generator gets it.
struct CutOutPhoto {
  core::Image photo, square;
  core::Findings findings;
};

CutOutPhoto CutOutObject(const LiftRequest& request, const physics_params::Category& category) {
  core::ImageReadOptions read;
  read.max_side = asset_lift::LiftOptions().max_side;
  CutOutPhoto cut;
  cut.photo = core::ReadImage(request.photo, read);
  asset_lift::SegmentationOptions options;
  options.network = request.segmenter;
  options.round_object = PriorOf(category).round;
  options.seed = request.seed;
  std::optional<core::Image> mask;
  if (request.mask) mask = core::ReadImage(*request.mask);
  try {
    const asset_lift::Matte matte = asset_lift::SegmentObject(cut.photo, mask, options);
    cut.square = CenteredCutOut(cut.photo, matte);
    cut.findings.push_back({"segmentation", core::Severity::kInfo, request.photo.filename(),
                            "the object was cut out by " + matte.method, matte.area});
  } catch (const core::Error& error) {
    throw core::Error(error.what(), request.photo.string());
  }
  return cut;
}

// Composes the photo, the picture that the generator got, and the mesh from its front.
core::Image GeneratedSheet(const CutOutPhoto& cut, const core::TexturedMesh& mesh) {
  constexpr double kElevation = 15.0 * std::numbers::pi / 180.0, kFieldOfView = 0.61;  // rad
  constexpr int kSide = 512;                                                           // pixels
  const Eigen::AlignedBox3d box = core::Bounds(mesh.mesh);
  const double distance = 0.55 * box.diagonal().norm() / std::sin(0.5 * kFieldOfView);
  const core::Camera camera = core::OrbitCamera(
      box.center(), distance, kElevation, -0.5 * std::numbers::pi, kFieldOfView, kSide, kSide);
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  return core::ContactSheet(
      {cut.photo, cut.square, render::RenderForward(scene, camera, options).color}, 3);
}

// Writes the generator's file into `folder` and returns the path of its mesh.
fs::path WriteGenerated(const GeneratedMesh& generated, const fs::path& folder) {
  const fs::path file = folder / ("generated" + generated.extension);
  core::WriteFile(file, generated.bytes);
  if (generated.extension != ".zip") return file;
  fs::create_directory(folder / "unpacked");
  return assets::ExtractMeshArchive(file, folder / "unpacked");
}

// Replaces the name of a temporary file, which means nothing to the reader.
std::string WithoutPath(std::string text, const fs::path& folder, const std::string& generator) {
  const std::string path = folder.string();
  for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path)) {
    const std::size_t end = std::min(text.find_first_of(":' ", at + path.size()), text.size());
    text.replace(at, end - at, "the mesh from " + generator);
  }
  return text;
}

// Returns the import's options for a mesh of unknown scale.
ImportOptions OptionsFor(const LiftRequest& request, const CutOutPhoto& cut,
                         const GeneratedMesh& generated) {
  ImportOptions options;
  options.category = request.category;
  options.up = request.generator.up;
  options.height = request.height;
  options.size = request.size;
  options.stated = request.stated;
  options.budget = request.budget;
  options.seed = request.seed;
  options.force = request.force;
  options.sampled_size = true;
  options.source = request.photo.filename().string() + " by the generator " + generated.generator;
  options.earlier = cut.findings;
  options.earlier.insert(options.earlier.end(), generated.findings.begin(),
                         generated.findings.end());
  options.earlier.push_back({"generated", core::Severity::kInfo, request.photo.filename().string(),
                             "the mesh was made by the generator " + generated.generator +
                                 "; its back and its proportions are that program's guess",
                             static_cast<double>(generated.bytes.size())});
  options.add_files = [&cut](const core::TexturedMesh& mesh, const fs::path& folder) {
    core::WritePng(folder / "matte.png", cut.square);
    core::WritePng(folder / "lift.png", GeneratedSheet(cut, mesh));
  };
  return options;
}

}  // namespace

LiftOutcome LiftByGenerator(const LiftRequest& request, core::Progress* progress) {
  Validate(request.generator);
  const physics_params::Resolution category = physics_params::RequireCategory(request.category);
  // An output that cannot be written is reported before the generator works for minutes.
  { const core::StagedFolder writable(request.output, request.force); }
  const CutOutPhoto cut = CutOutObject(request, *category.category);
  const auto start = std::chrono::steady_clock::now();
  const std::string png = core::EncodePng(cut.square);
  const GeneratedMesh generated = request.generator.command.empty()
                                      ? AskGeneratorServer(png, request.generator, progress)
                                      : RunGeneratorCommand(png, request.generator, progress);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (!request.keep_generated.empty()) core::WriteFile(request.keep_generated, generated.bytes);

  const core::TemporaryFolder folder;
  const fs::path output =
      request.output.filename().empty() ? request.output.parent_path() : request.output;
  ImportItem item;
  try {
    item.mesh = WriteGenerated(generated, folder.path());
  } catch (const core::Error& error) {
    throw core::Error(WithoutPath(error.what(), folder.path(), generated.generator));
  }
  item.name = output.filename().string();
  item.root = item.mesh.parent_path();
  const ImportOutcome imported =
      ImportAll({item}, output.parent_path(), OptionsFor(request, cut, generated), progress)
          .front();
  core::CheckCancelled();
  if (!imported.refusal.empty()) {
    throw core::Error(WithoutPath(imported.refusal, folder.path(), generated.generator));
  }
  LiftOutcome outcome{output, imported.seconds, imported.findings,
                      std::numeric_limits<double>::quiet_NaN()};
  outcome.seconds["generator"] = seconds.count();
  return outcome;
}

}  // namespace simwright::workflows
