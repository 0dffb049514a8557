#include "cli/language_model_options.h"

#include <cstdio>
#include <cstdlib>

#include "cli/number_validators.h"
#include "core/error.h"
#include "llm/make_chat_model.h"

namespace simwright::cli {

void AddLanguageModel(CLI::App* command, LanguageModelOptions* options) {
  CLI::Option* url = command->add_option(
      "--llm", options->url,
      "Ask the language model at this address, e.g. http://localhost:8080/v1; 'env': the one in "
      "SIMWRIGHT_LLM_URL. Its key is taken from SIMWRIGHT_LLM_KEY");
  const auto needs_server = [&](CLI::Option* option) { return option->needs(url); };
  needs_server(command->add_option("--llm-model", options->model,
                                   "The model's name"))
      ->default_str("SIMWRIGHT_LLM_MODEL");
  needs_server(command->add_option("--llm-cache", options->cache,
                                   "Folder of answers that are kept and not asked for twice"));
  needs_server(command
                   ->add_option("--llm-price", options->prices,
                                "Prices per million input and output tokens, to print the cost")
                   ->expected(2)
                   ->check(CLI::NonNegativeNumber));
  needs_server(command->add_option("--llm-timeout", options->timeout, "Seconds for one answer")
                   ->capture_default_str()
                   ->check(Positive()));
  CLI::Option* record = needs_server(
      command->add_option("--record", options->record, "Write questions and answers to this file"));
  command->add_option("--replay", options->replay, "Answer from such a file; no network is used")
      ->excludes(url)
      ->excludes(record);
}

std::unique_ptr<llm::ChatModel> MakeLanguageModel(const LanguageModelOptions& options,
                                                  const CommonOptions& common) {
  llm::ChatModelOptions model;
  model.replay = options.replay;
  if (options.replay.empty()) {
    if (options.url != "env") model.url = options.url;
    model.model = options.model;
    model.cache = options.cache;
    model.record = options.record;
    model.replace_record = common.force;
    model.jitter_seed = common.seed;
    model.total_timeout = options.timeout;
    if (options.prices.size() == 2) {
      model.input_price = options.prices[0];
      model.output_price = options.prices[1];
    }
    model = llm::WithEnvironment(model, [](const char* name) { return std::getenv(name); });
    if (model.url.empty()) {
      throw core::Error("names no server", "SIMWRIGHT_LLM_URL",
                        "set it, or give the address with --llm");
    }
  }
  return llm::MakeChatModel(model);
}

std::string UsageLine(const llm::Usage& usage) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "language model: %lld answers, %lld of them kept ones, %lld requests, %lld tokens "
                "read, %lld written",
                static_cast<long long>(usage.answers), static_cast<long long>(usage.from_cache),
                static_cast<long long>(usage.attempts), static_cast<long long>(usage.tokens.input),
                static_cast<long long>(usage.tokens.output));
  std::string line = text;
  if (usage.cost) {
    std::snprintf(text, sizeof(text), ", cost %.6g", *usage.cost);
    line += text;
  }
  return line;
}

}  // namespace simwright::cli
