#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "llm/chat_model.h"

namespace simwright::cli {

// The flags of every subcommand that may query a language model.
struct LanguageModelOptions {
  std::string url;  // "env": SIMWRIGHT_LLM_URL; empty: no server
  std::string model;
  std::filesystem::path cache, record, replay;
  std::vector<double> prices;  // input and output, per million tokens; empty: unknown
  double timeout = 600.0;      // per answer, s

  bool given() const { return !url.empty() || !replay.empty(); }
};

// Adds --llm, --llm-model, --llm-cache, --llm-price, --llm-timeout, --record and --replay.
void AddLanguageModel(CLI::App* command, LanguageModelOptions* options);

// Makes the model that the flags and the environment (docs/llm.md) describe. --force lets --record
// replace a transcript. Throws core::Error if they describe none.
std::unique_ptr<llm::ChatModel> MakeLanguageModel(const LanguageModelOptions& options,
                                                  const CommonOptions& common);

// Formats one line for people: the number of queries, the source of the answers, and the cost.
std::string UsageLine(const llm::Usage& usage);

}  // namespace simwright::cli
