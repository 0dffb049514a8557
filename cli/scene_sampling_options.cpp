#include "cli/scene_sampling_options.h"

namespace simwright::cli {

void AddSceneSamplingOptions(CLI::App* command, std::filesystem::path* text_encoder,
                             scene::SampleOptions* sampling) {
  command->add_option(
      "--text-encoder", *text_encoder,
      "The TorchScript text encoder that the model was trained with, if it has one");
  command->add_option("--steps", sampling->steps, "Diffusion steps; 0: all")->capture_default_str();
  command->add_option("--eta", sampling->eta, "Fraction of the noise kept in each step")
      ->capture_default_str();
  command->add_flag("--device-noise", sampling->noise_on_device,
                    "Draw noise on the GPU, which is faster: other scenes for the same seed");
}

}  // namespace simwright::cli
