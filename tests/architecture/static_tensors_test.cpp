// No tensor, generator or network lives in static or thread storage: those of a GPU would be freed
// after CUDA has ended, which crashes a program that has done its work.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "tests/architecture/include_lines.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

// Types of libtorch that hold memory of a device, and ours of nn/ and scene/model/ that hold them.
constexpr char kHolders[] =
    "((torch|at|c10)::(Tensor|TensorList|Generator|nn::\\w+|optim::\\w+|jit::\\S+|autograd::\\w+)|"
    "NamedTensors|DeviceTable|DiffusionSchedule|CategoryDiffusion|SceneDiffusion|SceneModel|"
    "CleanScenes|NoisyScenes|DenoisingBatch|Trainer|Denoiser)";

// True for a line that declares such a variable: `static` or `thread_local` in any scope, or in no
// scope. Functions have a parenthesis after their name.
bool DeclaresStaticTensor(const std::string& line) {
  const std::string end = "[^()]*[\\s>&*]\\w+\\s*(;|=|\\{)";
  static const std::regex marked("\\b(static|thread_local)\\b[^()]*\\b" + std::string(kHolders) +
                                 end);
  static const std::regex global("^(const |inline |constexpr )*(std::\\w+<[^()]*)?(\\w+::)?" +
                                 std::string(kHolders) + end);
  static const std::regex deduced(
      "\\b(static|thread_local)\\b[^()]*\\bauto\\b.*=.*\\b(torch|at)::");
  return std::regex_search(line, marked) || std::regex_search(line, global) ||
         std::regex_search(line, deduced);
}

TEST(StaticTensors, AreRecognised) {
  for (const char* const bad :
       {"static at::Tensor cache;", "  static const torch::Tensor table = torch::ones({3});",
        "torch::Tensor cache;", "const at::Tensor kTable = torch::zeros({2});",
        "thread_local at::Generator generator{};", "std::map<int, torch::Tensor> tables;",
        "  static std::vector<torch::Tensor> all = Make();",
        "static nn::DeviceTable table{Values()};", "  static const auto ones = torch::ones({1});",
        "inline torch::nn::Linear map{nullptr};", "nn::DiffusionSchedule schedule = Linear();",
        "static torch::jit::script::Module module;"}) {
    EXPECT_TRUE(DeclaresStaticTensor(bad)) << bad;
  }
  for (const char* const good :
       {"  static torch::Tensor Draw(const torch::Tensor& p, const at::Generator& generator);",
        "torch::Tensor Attended(const torch::Tensor& q, const torch::Tensor& k,",
        "  torch::Tensor values_;", "  const torch::Tensor one = torch::ones({1});",
        "  static DiffusionSchedule Cosine(int steps);", "static std::mutex mutex;",
        "  return static_cast<int>(torch::ones({1}).numel());",
        "std::vector<torch::Tensor> ModulationImpl::forward(const torch::Tensor& vector) {"}) {
    EXPECT_FALSE(DeclaresStaticTensor(good)) << good;
  }
}

TEST(StaticTensors, AreNowhere) {
  int lines = 0;
  for (const auto& [module, floor] : kFloor) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(SIMWRIGHT_SOURCE_DIR) / module)) {
      const std::string ending = entry.path().extension();
      if (ending != ".h" && ending != ".cpp") continue;
      std::ifstream in(entry.path());
      for (std::string text; std::getline(in, text);) {
        ++lines;
        const bool may_be_static = !text.starts_with(' ') ||
                                   text.find("static") != std::string::npos ||
                                   text.find("thread_local") != std::string::npos;
        if (!may_be_static) continue;
        EXPECT_FALSE(DeclaresStaticTensor(text)) << entry.path() << ": " << text;
      }
    }
  }
  EXPECT_GT(lines, 50000);
}

}  // namespace
}  // namespace simwright
