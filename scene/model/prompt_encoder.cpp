#include "scene/model/prompt_encoder.h"

#include <algorithm>
#include <mutex>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "nn/torch_script.h"

namespace simwright::scene {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kLargestFile = 1ull << 34;  // bytes
constexpr char kOutputRule[] =
    "forward(pieces, mask) must return finite floats (B x L x D) for int64 (B x L)";

fs::path VocabularyBeside(const fs::path& file) {
  fs::path named = file;
  named += ".vocab.txt";
  if (fs::exists(named)) return named;
  const fs::path common = file.parent_path() / "vocab.txt";
  if (fs::exists(common)) return common;
  throw core::Error("the text encoder has no vocabulary", file.string(),
                    "put its word pieces, one per line, into " + named.filename().string() +
                        " or vocab.txt beside it");
}

torch::Tensor FirstTensor(const torch::jit::IValue& value, const std::string& where) {
  if (value.isTensor()) return value.toTensor();
  if (value.isTuple() && !value.toTupleRef().elements().empty()) {
    return FirstTensor(value.toTupleRef().elements()[0], where);
  }
  if (value.isGenericDict()) {
    const auto dict = value.toGenericDict();
    const auto found = dict.find(torch::jit::IValue("last_hidden_state"));
    if (found != dict.end()) return FirstTensor(found->value(), where);
  }
  throw core::Error("the text encoder returns no tensor", where, kOutputRule);
}

}  // namespace

struct ExternalTextEncoder::Script {
  torch::jit::script::Module module;
  std::mutex mutex;
};

ExternalTextEncoder::ExternalTextEncoder(const fs::path& file)
    : file_(file),
      script_(new Script{nn::LoadTorchScript(file), {}}),
      pieces_(WordPieces::Read(VocabularyBeside(file))),
      hash_(core::ContentHash(core::ReadFile(file, kLargestFile))) {
  script_->module.eval();
  const TextInput one = PiecesOf({"a cup"}, pieces_, 8);
  features_ = static_cast<int>(Features(one.pieces, one.mask).size(-1));
}

ExternalTextEncoder::~ExternalTextEncoder() = default;

torch::Tensor ExternalTextEncoder::Features(const torch::Tensor& pieces,
                                            const torch::Tensor& mask) const {
  const torch::NoGradGuard no_gradient;
  torch::jit::IValue output;
  try {
    const std::lock_guard lock(script_->mutex);
    output = script_->module.forward({pieces, mask.to(torch::kLong)});
  } catch (const std::exception& error) {
    const std::string cause = error.what();
    throw core::Error("the text encoder fails: " + cause.substr(0, cause.find('\n')),
                      file_.string(), kOutputRule);
  }
  const torch::Tensor features = FirstTensor(output, file_.string()).to(torch::kCPU, torch::kFloat);
  const bool right = features.dim() == 3 && features.size(0) == pieces.size(0) &&
                     features.size(1) == pieces.size(1) && features.size(2) > 0 &&
                     features.isfinite().all().item<bool>();
  if (!right) throw core::Error("the text encoder's output is wrong", file_.string(), kOutputRule);
  return features;
}

TextInput PiecesOf(const std::vector<std::string>& prompts, const WordPieces& pieces, int most) {
  std::vector<std::vector<int>> rows;
  size_t longest = 0;
  for (const std::string& prompt : prompts) {
    rows.push_back(pieces.Encode(prompt, most));
    longest = std::max(longest, rows.back().size());
  }
  const auto count = static_cast<std::int64_t>(rows.size());
  TextInput text;
  text.pieces =
      torch::full({count, static_cast<std::int64_t>(longest)}, pieces.pad(), torch::kLong);
  text.mask = torch::zeros(text.pieces.sizes(), torch::kBool);
  for (size_t i = 0; i < rows.size(); ++i) {
    std::int64_t* const ids = text.pieces.data_ptr<std::int64_t>() + i * longest;
    bool* const mask = text.mask.data_ptr<bool>() + i * longest;
    std::copy(rows[i].begin(), rows[i].end(), ids);
    std::fill(mask, mask + rows[i].size(), true);
  }
  return text;
}

TextInput TextInputOf(const std::vector<std::string>& prompts, const WordPieces& pieces, int most,
                      const ExternalTextEncoder* encoder) {
  TextInput text = PiecesOf(prompts, pieces, most);
  if (encoder == nullptr) return text;
  text.features = encoder->Features(text.pieces, text.mask);
  text.pieces = torch::Tensor();
  return text;
}

}  // namespace simwright::scene
