#include "texture/endpoints/make_image_generator.h"

#include "core/error.h"
#include "core/json.h"
#include "llm/redaction.h"
#include "texture/endpoints/endpoint_connection.h"
#include "texture/endpoints/endpoint_generators.h"

namespace simwright::texture {
namespace {

// Returns true if the answer at `path` is JSON that `fits`.
template <typename Fits>
bool AnswersJson(EndpointConnection* connection, const std::string& path, const Fits& fits) {
  const llm::HttpReply reply = connection->Probe(path);
  if (reply.status == 401 || reply.status == 403) {
    connection->Fail("status " + std::to_string(reply.status) + " at " + path,
                     "set SIMWRIGHT_IMAGE_KEY to a valid key, or state --dialect");
  }
  if (reply.status < 200 || reply.status > 299) return false;
  const std::optional<core::Json> json = core::TryParseJson(reply.body);
  return json && fits(*json);
}

ImageDialect FoundDialect(EndpointConnection* connection) {
  if (connection->host() == "api.openai.com") return ImageDialect::kOpenAi;
  const auto is_list = [](const core::Json& json) { return json.is_array(); };
  const auto has = [](const char* name) {
    return [name](const core::Json& json) { return core::FindMember(json, name) != nullptr; };
  };
  if (AnswersJson(connection, "/sdapi/v1/samplers", is_list)) return ImageDialect::kSdWebUi;
  if (AnswersJson(connection, "/system_stats", has("system"))) return ImageDialect::kComfyUi;
  if (AnswersJson(connection, "/models", has("data"))) return ImageDialect::kOpenAi;
  connection->Fail(
      "it speaks no known dialect: it answers none of /sdapi/v1/samplers (web UI with --api), "
      "/system_stats (ComfyUI) and /models (OpenAI, whose address ends in /v1)",
      "check the address, or state --dialect");
}

}  // namespace

void RequirePrompt(const ImageRequest& request, const EndpointConnection& connection) {
  std::string fault;
  if (!request.IsValid(&fault)) throw core::Error(fault, "the request for a picture");
  if (request.prompt.empty()) {
    throw core::Error("the server needs words beside the exemplar", connection.shown(),
                      "give --prompt");
  }
}

std::unique_ptr<ImageGenerator> MakeImageGenerator(const ImageGeneratorOptions& options,
                                                   llm::Clock& clock) {
  std::string fault;
  if (!options.IsValid(&fault)) throw core::Error(fault, "the image server's options");
  EndpointConnection connection(options, clock);
  const ImageDialect dialect =
      options.dialect == ImageDialect::kAuto ? FoundDialect(&connection) : options.dialect;
  if (!options.workflow.empty() && dialect != ImageDialect::kComfyUi) {
    throw core::Error(
        "a workflow is for ComfyUI, and the server speaks " + std::string(DialectName(dialect)),
        connection.shown());
  }
  switch (dialect) {
    case ImageDialect::kSdWebUi:
      return MakeWebUiGenerator(std::move(connection));
    case ImageDialect::kComfyUi:
      return MakeComfyGenerator(std::move(connection));
    default:
      return MakeOpenAiImageGenerator(std::move(connection));
  }
}

std::unique_ptr<ImageGenerator> MakeImageGenerator(const ImageGeneratorOptions& options) {
  return MakeImageGenerator(options, llm::SystemClock());
}

}  // namespace simwright::texture
