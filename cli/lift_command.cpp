#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/generator_flags.h"
#include "cli/number_validators.h"
#include "cli/stated_options.h"
#include "core/error.h"
#include "core/json.h"
#include "workflows/lift/lift.h"
#include "workflows/lift/mat_lift.h"
#include "workflows/lift/table_lift.h"
#include "workflows/lift/video_photos.h"

namespace simwright::cli {
namespace {

constexpr int kVideoFrames = 30;

struct LiftFlags {
  std::vector<std::filesystem::path> photos, flipped;
  std::filesystem::path mask;
  std::filesystem::path cameras;
  std::string shape = "auto";
  bool fast = false, outline = false, each = false, together = false;
  double ruler = 0.0;  // mm
  int frames = 0;      // of a video; 0: kVideoFrames
  GeneratorFlags generator;
  workflows::LiftRequest request;
};

// Prints the outcome of each photo: immediately for people, in one final object for machines.
class LiftPrinter {
 public:
  explicit LiftPrinter(const CommonOptions& common) : common_(common) {
    json_["assets"] = core::OrderedJson::array();
  }
  void Print(const workflows::LiftOutcome& outcome);
  void Print(const core::Findings& findings) {
    findings_.insert(findings_.end(), findings.begin(), findings.end());
    if (!common_.json) PrintFindings(findings, common_);
  }
  void Finish() {
    if (common_.json) PrintJson(json_, findings_);
  }

 private:
  const CommonOptions& common_;
  core::OrderedJson json_;
  core::Findings findings_;
};

void LiftPrinter::Print(const workflows::LiftOutcome& outcome) {
  findings_.insert(findings_.end(), outcome.findings.begin(), outcome.findings.end());
  if (common_.json) {
    json_["assets"].push_back({{"folder", outcome.folder.string()},
                               {"silhouette_iou", outcome.silhouette_iou},
                               {"seconds", outcome.seconds}});
    return;
  }
  PrintFindings(outcome.findings, common_);
  std::printf("asset:   %s\npicture: %s\n", outcome.folder.c_str(),
              (outcome.folder / "preview.png").c_str());
}

// Several photos of one object take another road than a single photo: an option that only steers
// the latter is refused instead of ignored. `photos`: how a message names them.
void RequireNoneUnused(const LiftFlags& flags, const std::string& photos, bool height_is_used,
                       bool ruler_is_used) {
  const workflows::LiftRequest& one = flags.request;
  const std::pair<bool, const char*> unused[] = {{one.height > 0.0 && !height_is_used, "--height"},
                                                 {flags.ruler > 0.0 && !ruler_is_used, "--ruler"},
                                                 {flags.fast, "--fast"},
                                                 {flags.outline, "--outline"},
                                                 {one.delight, "--delight"},
                                                 {flags.shape != "auto", "--shape"},
                                                 {!one.prior.empty(), "--prior"},
                                                 {one.elevation_degrees >= 0.0, "--elevation"},
                                                 {one.fov_degrees > 0.0, "--fov"},
                                                 {one.segmenter != nullptr, "--segmenter"},
                                                 {one.generator.given(), "--generator"}};
  for (const auto& [given, option] : unused) {
    if (!given) continue;
    throw core::Error(std::string(option) + " is not used with " + photos, "",
                      photos == "a video"
                          ? "leave it out"
                          : "leave it out, or use --each if each photo shows another object");
  }
}

workflows::MatLiftRequest MatRequest(const LiftFlags& flags) {
  const workflows::LiftRequest& one = flags.request;
  workflows::MatLiftRequest request{flags.photos, one.category, flags.flipped, 0.1,
                                    one.size,     one.stated,   one.budget,    one.seed,
                                    one.output,   one.force};
  if (flags.ruler > 0.0) request.ruler = 0.001 * flags.ruler;
  RequireNoneUnused(flags, "photos on a mat", false, true);
  return request;
}

void RequireMatForFlipped(const LiftFlags& flags) {
  if (flags.flipped.empty()) return;
  throw core::Error("--flipped needs photos on a mat in both sets", "",
                    "print one with `simwright mat`, and leave out --each");
}

workflows::TableLiftRequest TableRequest(const LiftFlags& flags) {
  RequireNoneUnused(flags, "photos of one object without a mat", true, false);
  const workflows::LiftRequest& one = flags.request;
  return {flags.photos, one.category, one.height, one.size, one.stated,
          one.budget,   one.seed,     one.output, one.force};
}

// Frames of videos that take the place of photos.
using TakenVideo = std::unique_ptr<workflows::VideoPhotos>;

// Chooses frames of a video and puts them in its place. Returns null if `photos` holds no video.
TakenVideo TakeVideo(int frames, std::vector<std::filesystem::path>* photos,
                     core::Progress* progress) {
  const auto video = std::find_if(photos->begin(), photos->end(), workflows::IsVideo);
  if (video == photos->end()) return nullptr;
  if (photos->size() > 1) {
    throw core::Error("a video is given beside other files", video->string(),
                      "give one video, or photos");
  }
  auto taken = std::make_unique<workflows::VideoPhotos>(*video, frames > 0 ? frames : kVideoFrames,
                                                        progress);
  *photos = taken->photos();
  return taken;
}

bool HoldVideo(const std::vector<std::filesystem::path>& photos) {
  return std::any_of(photos.begin(), photos.end(), workflows::IsVideo);
}

// Refuses the options that a lift of a video would not use, before the video is decoded.
void RequireNoneUnusedByVideo(const LiftFlags& flags) {
  const std::pair<bool, const char*> unused[] = {{flags.each, "--each"},
                                                 {!flags.mask.empty(), "--mask"},
                                                 {!flags.cameras.empty(), "--cameras"}};
  for (const auto& [given, option] : unused) {
    if (given) {
      throw core::Error(std::string(option) + " is not used with a video", "", "leave it out");
    }
  }
  RequireNoneUnused(flags, "a video", true, true);
}

// Lifts a video, or photos and a video of the object turned over.
workflows::LiftOutcome LiftVideo(LiftFlags flags, core::Progress* progress) {
  const workflows::LiftRequest& one = flags.request;
  RequireNoneUnusedByVideo(flags);
  workflows::RequireLiftable(one.category, one.output, one.force);
  const TakenVideo video = TakeVideo(flags.frames, &flags.photos, progress);
  const TakenVideo flipped = TakeVideo(flags.frames, &flags.flipped, progress);
  const auto name_source = [&](auto request) {
    if (video) request.source = video->source();
    for (const TakenVideo* taken : {&video, &flipped}) {
      if (*taken) request.findings.push_back((*taken)->finding());
    }
    return request;
  };
  if (workflows::ShowMat(flags.photos)) {
    return workflows::LiftToFolder(name_source(MatRequest(flags)), progress);
  }
  RequireMatForFlipped(flags);
  return workflows::LiftToFolder(name_source(TableRequest(flags)), progress);
}

// Returns a finding that suggests --together for photos that are lifted one by one but show one
// scene.
core::Findings SuggestTogether(const LiftFlags& flags) {
  if (flags.each || flags.photos.size() < 4 || !workflows::ShowOneScene(flags.photos)) return {};
  return {{"photos-overlap", core::Severity::kWarning, "",
           "the photos show one scene, but each is lifted to an asset of its own", 0.0,
           "use --together if they show one object, or --each to confirm"}};
}

void ApplyFlags(const CommonOptions& common, LiftFlags* flags) {
  workflows::LiftRequest& request = flags->request;
  request.seed = common.seed;
  request.force = common.force;
  ApplyGenerator(flags->generator, &request);
  if (!flags->mask.empty()) request.mask = flags->mask;
  request.shape = flags->shape == "fitted"                   ? workflows::LiftShape::kFitted
                  : flags->shape == "free" || flags->outline ? workflows::LiftShape::kFree
                                                             : workflows::LiftShape::kAuto;
  if (flags->fast) request.effort = asset_lift::LiftEffort::kFast;
  if (flags->outline) request.effort = asset_lift::LiftEffort::kOutline;
}

workflows::MultiLiftRequest CamerasRequest(const LiftFlags& flags) {
  if (flags.photos.size() < 2) throw core::Error("--cameras needs several photos of one object");
  if (flags.request.mask) throw core::Error("--mask needs a single photo");
  if (flags.request.segmenter) throw core::Error("--segmenter is not used with --cameras");
  if (flags.shape == "fitted") throw core::Error("--shape fitted is not used with --cameras");
  const workflows::LiftRequest& one = flags.request;
  return {flags.photos, flags.cameras, one.category, one.height, one.size, one.stated,
          one.budget,   one.effort,    one.seed,     one.output, one.force};
}

// Lifts each photo to an asset of its own.
void LiftEach(LiftFlags flags, LiftPrinter* printer, core::Progress* progress) {
  printer->Print(SuggestTogether(flags));
  const std::filesystem::path output = flags.request.output;
  for (const std::filesystem::path& photo : flags.photos) {
    flags.request.photo = photo;
    // Several photos show several objects, with a folder each.
    flags.request.output = flags.photos.size() > 1 ? output / photo.stem() : output;
    printer->Print(workflows::LiftToFolder(flags.request, progress));
  }
}

int Lift(LiftFlags flags, const CommonOptions& common) {
  asset_build::Validate(flags.request.size);
  Validate(flags.request.stated);
  Validate(flags.request.budget);
  core::Progress progress(common.ProgressStyle());
  LiftPrinter printer(common);
  ApplyFlags(common, &flags);
  if (HoldVideo(flags.photos) || HoldVideo(flags.flipped)) {
    printer.Print(LiftVideo(std::move(flags), &progress));
    printer.Finish();
    return 0;
  }
  if (flags.frames > 0) throw core::Error("--frames needs a video");
  if (!flags.cameras.empty()) {
    printer.Print(workflows::LiftToFolder(CamerasRequest(flags), &progress));
    printer.Finish();
    return 0;
  }
  if (flags.photos.size() > 1 && flags.request.mask) {
    throw core::Error("--mask needs a single photo");
  }
  if (flags.photos.size() > 1 && !flags.request.keep_generated.empty()) {
    throw core::Error("--keep-generated needs a single photo");
  }
  if (!flags.each && workflows::ShowMat(flags.photos)) {
    printer.Print(workflows::LiftToFolder(MatRequest(flags), &progress));
  } else {
    RequireMatForFlipped(flags);
    if (flags.together) {
      printer.Print(workflows::LiftToFolder(TableRequest(flags), &progress));
    } else {
      LiftEach(std::move(flags), &printer, &progress);
    }
  }
  printer.Finish();
  return 0;
}

}  // namespace

void AddLift(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<LiftFlags>();
  CLI::App* command =
      app->add_subcommand("lift", "Reconstruct a simulation-ready asset from a photo");
  command->footer(
      "Example:\n  simwright lift examples/apple.jpg --category apple -o apple\n"
      "  simwright lift coffee.png --mask coffee_mask.png --category 'coffee cup' -o cup\n"
      "  simwright lift front.jpg left.jpg back.jpg --cameras cams.json --category mug -o mug\n"
      "  simwright lift photos/*.jpg --category mug -o mug    (photos on a mat, see simwright "
      "mat)\n"
      "  simwright lift up/*.jpg --flipped down/*.jpg --category mug -o mug    (with the "
      "underside)\n"
      "  simwright lift photos/*.jpg --together --category mug -o mug    (without a mat)\n"
      "  simwright lift turn.mp4 --category mug -o mug    (a video, with a mat or without)\n"
      "  simwright lift mug.jpg --category mug --generator http://localhost:8081/generate -o mug\n"
      "  simwright lift mug.jpg --category mug --generator-command 'my_model {in} {out}' -o mug\n"
      "  simwright lift mug.jpg --category mug --segmenter u2net.onnx -o mug");
  command
      ->add_option(
          "photos", flags->photos,
          "PNG, JPEG, WebP, TIFF, GIF ... of one object each; with --cameras, --together, or "
          "on a mat that `simwright mat` wrote, all of one object; or one video from all around it")
      ->required();
  command->add_option("--category", flags->request.category, "The object's category, e.g. mug")
      ->required();
  command->add_option("-o,--output", flags->request.output, "The asset folder")->required();
  command->add_option("--mask", flags->mask, "Image that is bright where the object is");
  command->add_option("--height", flags->request.height, "The object's true height, m")
      ->check(Positive())
      ->default_str("sampled from the category");
  AddStatedOptions(command, &flags->request.size, &flags->request.stated);
  AddPartOptions(command, &flags->request.budget);
  command->get_option("--height")->excludes("--size");
  command->add_option("--cameras", flags->cameras,
                      "JSON with the cameras of several photos of one object (docs/formats.md)");
  command
      ->add_option("--prior", flags->request.prior,
                   "A TorchScript view prior, e.g. an exported Zero-1-to-3")
      ->default_str("the shipped one");
  command
      ->add_option("--ruler", flags->ruler,
                   "The length of the printed mat's ruler as measured, mm: corrects a wrong print")
      ->check(CLI::Range(50.0, 200.0))
      ->default_str("100");
  command
      ->add_option("--flipped", flags->flipped,
                   "Photos (or a video) of the same object on the mat, turned over: they show its "
                   "underside")
      ->excludes("--cameras");
  command->add_option("--frames", flags->frames, "Frames of a video that are used at most")
      ->check(CLI::Range(8, 200))
      ->default_str(std::to_string(kVideoFrames));
  command->add_flag("--each", flags->each, "Each photo shows another object, even on a mat");
  command
      ->add_flag("--together", flags->together,
                 "All photos show one object on a table, from all around (docs/capture.md)")
      ->excludes("--each")
      ->excludes("--cameras");
  command->add_flag("--fast", flags->fast, "Without radiance field: under a minute");
  command->add_flag("--outline", flags->outline, "Only inflate the silhouette: a few seconds");
  command->add_flag("--delight", flags->request.delight,
                    "Divide the photo's shading out of the texture and replace highlights "
                    "(docs/materials.md)");
  command
      ->add_option("--elevation", flags->request.elevation_degrees,
                   "The angle by which the camera looked down, degrees")
      ->check(CLI::Range(0.0, 85.0))
      ->default_str("estimated");
  command
      ->add_option("--fov", flags->request.fov_degrees,
                   "Field of view along the longer side, degrees")
      ->check(CLI::Range(1.0, 160.0))
      ->default_str("EXIF, else 35");
  command
      ->add_option("--shape", flags->shape,
                   "fitted: an object of the library, articulated if its kind is; free: "
                   "reconstructed; auto: the one that agrees better with the photo")
      ->check(CLI::IsMember({"auto", "fitted", "free"}))
      ->capture_default_str();
  AddGenerator(command, &flags->generator, &flags->request);
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return Lift(*flags, *common); }; });
}

}  // namespace simwright::cli
