#include "nn/resume.h"

#include <sstream>

#include "core/error.h"
#include "core/files.h"

namespace simwright::nn {

void SaveTrainingState(const std::filesystem::path& path, int step, const torch::nn::Module& module,
                       const torch::optim::Optimizer& optimizer, const Ema& average) {
  torch::serialize::OutputArchive archive, network, adam, mean;
  archive.write("step", torch::tensor(step), true);
  module.save(network);
  archive.write("module", network);
  optimizer.save(adam);
  archive.write("optimizer", adam);
  average.Save(&mean);
  archive.write("average", mean);
  std::ostringstream bytes;
  archive.save_to(bytes);
  core::WriteFile(path, bytes.str());
}

int LoadTrainingState(const std::filesystem::path& path, torch::nn::Module* module,
                      torch::optim::Optimizer* optimizer, Ema* average) {
  if (!std::filesystem::exists(path)) return 0;
  std::istringstream bytes(core::ReadFile(path, 1ull << 34));
  try {
    torch::serialize::InputArchive archive, network, adam, mean;
    archive.load_from(bytes);
    torch::Tensor step;
    archive.read("step", step, true);
    archive.read("module", network);
    module->load(network);
    archive.read("optimizer", adam);
    optimizer->load(adam);
    archive.read("average", mean);
    average->Load(&mean);
    return step.item<int>();
  } catch (const c10::Error&) {
    throw core::Error("is no training state of this network", path.string(),
                      "remove it, or train without --resume");
  }
}

}  // namespace simwright::nn
