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
      "Query the language model at this address, e.g. http://localhost:8080/v1; 'env': the one in "
      "SIMWRIGHT_LLM_URL. The key is read from SIMWRIGHT_LLM_KEY");
  const auto needs_server = [&](CLI::Option* option) { return option->needs(url); };
  needs_server(command->add_option("--llm-model", options->model, "The model's name"))
      ->default_str("SIMWRIGHT_LLM_MODEL");
  needs_server(command->add_option("--llm-cache", options->cache, "Folder that caches answers"));
  needs_server(command
                   ->add_option("--llm-price", options->prices,
                                "Prices per million input and output tokens, to print the cost")
                   ->expected(2)
                   ->check(CLI::NonNegativeNumber));
  needs_server(command->add_option("--llm-timeout", options->timeout, "Timeout per answer, seconds")
                   ->capture_default_str()
                   ->check(Positive()));
  CLI::Option* record = needs_server(
      command->add_option("--record", options->record, "Record queries and answers in this file"));
  command->add_option("--replay", options->replay, "Answer from a recorded file, without network")
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
      throw core::Error("does not name a server", "SIMWRIGHT_LLM_URL",
                        "set it, or give the address with --llm");
    }
  }
  return llm::MakeChatModel(model);
}

std::string UsageLine(const llm::Usage& usage) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "language model: %lld answers, %lld of them cached, %lld requests, %lld input "
                "tokens, %lld output tokens",
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
