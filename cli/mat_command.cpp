#include <cstdio>
#include <memory>

#include "capture/capture_mat.h"
#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/usage.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"

namespace simwright::cli {
namespace {

struct MatFlags {
  std::filesystem::path output;
  capture::PaperSize paper = capture::PaperSize::kA4;
};

int Mat(const MatFlags& flags, const CommonOptions& common) {
  if (std::filesystem::exists(flags.output) && !common.force) {
    throw core::Error("exists already", flags.output.string(), "use --force or another name");
  }
  const capture::CaptureMat& mat = capture::CaptureMatOf(flags.paper);
  core::WriteFile(flags.output, capture::MatPdf(mat));
  if (common.json) {
    const core::OrderedJson json = {{"file", flags.output.string()},
                                    {"paper", mat.name},
                                    {"square_m", mat.square},
                                    {"columns", mat.columns},
                                    {"rows", mat.rows}};
    PrintJson(json, {});
    return 0;
  }
  std::printf(
      "mat:  %s (%s, %d x %d squares of %.0f mm)\n"
      "next: print it at 100 %%, measure its ruler, put the object in the middle, take 20 to 30\n"
      "      photos from all around at three heights, and run\n"
      "      simwright lift photos/*.jpg --category NAME -o DIR\n",
      flags.output.c_str(), mat.name.c_str(), mat.columns, mat.rows, 1000.0 * mat.square);
  return 0;
}

}  // namespace

void AddMat(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<MatFlags>();
  CLI::App* command = app->add_subcommand(
      "mat", "Write a printable mat that gives photos their cameras and true scale");
  command->footer("Example:\n  simwright mat -o mat.pdf\n  simwright mat --size A3 -o mat_a3.pdf");
  command->add_option("-o,--output", flags->output, "The PDF file")->required();
  std::vector<std::string> names;
  for (const capture::CaptureMat& mat : capture::CaptureMats()) names.push_back(mat.name);
  AddChoice(command, "--size", names, "A4", "The paper", [flags](const std::string& name) {
    for (const capture::CaptureMat& mat : capture::CaptureMats()) {
      if (mat.name == name) flags->paper = mat.paper;
    }
  });
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] { *run = [=] { return Mat(*flags, *common); }; });
}

}  // namespace simwright::cli
