#include "cli/generator_flags.h"

#include <cstdlib>
#include <map>

#include "cli/number_validators.h"
#include "core/error.h"

namespace simwright::cli {
namespace {

const std::map<std::string, workflows::GeneratorFormat> kFormats = {
    {"auto", workflows::GeneratorFormat::kAuto},
    {"json", workflows::GeneratorFormat::kJson},
    {"multipart", workflows::GeneratorFormat::kMultipart}};
const std::map<std::string, asset_lift::InputNormalisation> kNormalisations = {
    {"auto", asset_lift::InputNormalisation::kByName},
    {"imagenet", asset_lift::InputNormalisation::kImageNet},
    {"half", asset_lift::InputNormalisation::kHalf},
    {"none", asset_lift::InputNormalisation::kNone}};

void AddServer(CLI::App* command, GeneratorFlags* flags, workflows::GeneratorOptions* generator) {
  CLI::Option* url = command->get_option("--generator");
  const auto needs_server = [&](CLI::Option* option) { return option->needs(url); };
  needs_server(
      command
          ->add_option("--generator-format", flags->format,
                       "The form of the request; auto: JSON, then multipart if the server refuses "
                       "it with status 400, 415 or 422")
          ->check(CLI::IsMember(kFormats)))
      ->capture_default_str();
  needs_server(
      command->add_option("--generator-field", generator->field, "The photo's name in the request"))
      ->capture_default_str();
  needs_server(command
                   ->add_option("--generator-parameter", flags->parameters,
                                "A further field of the request, NAME=VALUE, e.g. texture=true")
                   ->expected(1)
                   ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll));
  needs_server(command->add_option("--generator-status", generator->status_url,
                                   "The address of a task's state, with {id} for the task's id"))
      ->default_str("named by the server, else status/ID beside the address");
}

void AddSegmenter(CLI::App* command, GeneratorFlags* flags) {
  CLI::Option* file =
      command
          ->add_option(
              "--segmenter", flags->segmenter,
              "A network that finds the object, as ONNX (fp32) or TorchScript, e.g. U2-Net "
              "or IS-Net")
          ->excludes("--mask");
  command
      ->add_option("--segmenter-size", flags->segmenter_side,
                   "Pixels per side of the network's input")
      ->check(CLI::Range(16, 4096))
      ->default_str("from the file, else 320")
      ->needs(file);
  command
      ->add_option("--segmenter-input", flags->normalisation,
                   "The network's input values: ImageNet's mean and deviation, half (minus 0.5) or "
                   "none; auto: half if the file's name has 'isnet', else imagenet")
      ->check(CLI::IsMember(kNormalisations))
      ->capture_default_str()
      ->needs(file);
}

}  // namespace

void AddGenerator(CLI::App* command, GeneratorFlags* flags, workflows::LiftRequest* request) {
  workflows::GeneratorOptions* generator = &request->generator;
  CLI::Option* url = command->add_option(
      "--generator", generator->url,
      "Have the server at this address make the mesh (docs/generator.md), e.g. "
      "http://localhost:8081/generate. Its key is read from SIMWRIGHT_GENERATOR_KEY");
  // A configuration file, which may come from elsewhere, starts no program.
  CLI::Option* program =
      command
          ->add_option("--generator-command", generator->command,
                       "Have a program make the mesh: 'prog {in} {out}' with the paths of the "
                       "cut-out photo (PNG) and of the GLB to write")
          ->configurable(false)
          ->excludes(url);
  AddServer(command, flags, generator);
  command
      ->add_option("--generator-timeout", generator->timeout,
                   "Time for the mesh to arrive, seconds")
      ->check(Positive())
      ->capture_default_str();
  command->add_option("--generator-up", flags->up, "The up axis of the generator's mesh: x, y or z")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->default_str("y in GLB, guessed in OBJ and PLY");
  command
      ->add_option("--keep-generated", request->keep_generated,
                   "Also write the generator's mesh to this file")
      ->default_str("not kept");
  for (const char* unused :
       {"--cameras", "--prior", "--fast", "--outline", "--delight", "--elevation", "--fov"}) {
    command->get_option(unused)->excludes(url)->excludes(program);
  }
  AddSegmenter(command, flags);
}

void ApplyGenerator(const GeneratorFlags& flags, workflows::LiftRequest* request) {
  workflows::GeneratorOptions& generator = request->generator;
  generator.format = kFormats.at(flags.format);
  generator.up = flags.up.empty() ? 0 : flags.up[0];
  generator.jitter_seed = request->seed;
  generator.parameters.clear();
  for (const std::string& parameter : flags.parameters) {
    const std::size_t equals = parameter.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw core::Error("'" + parameter + "' is not NAME=VALUE", "--generator-parameter",
                        "for example texture=true");
    }
    generator.parameters.emplace_back(parameter.substr(0, equals), parameter.substr(equals + 1));
  }
  const char* const key = std::getenv("SIMWRIGHT_GENERATOR_KEY");
  if (key != nullptr && !generator.url.empty()) generator.key = key;
  if (!flags.segmenter.empty()) {
    request->segmenter = asset_lift::LoadSalientNetwork(
        flags.segmenter, {flags.segmenter_side, kNormalisations.at(flags.normalisation)});
  }
}

}  // namespace simwright::cli
