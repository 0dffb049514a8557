// Answers of image servers, and workflows with placeholders: a text or nothing, whatever the bytes
// are; the words of a prompt stay words.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include "core/json.h"
#include "texture/endpoints/comfy_graph.h"
#include "texture/endpoints/endpoint_connection.h"
#include "texture/endpoints/multipart_form.h"

namespace {

using namespace simwright::texture;

void ReadAnAnswer(const std::string& text) {
  if (DescribeAnswer(text).empty()) std::abort();
  SpeaksOfContentFilter(MessageInAnswer(text));
}

void FillAWorkflow(const std::string& text) {
  const std::optional<simwright::core::Json> json = simwright::core::TryParseJson(text);
  if (!json) return;
  const simwright::core::OrderedJson workflow =
      simwright::core::ParseOrderedJson(text, "a workflow");
  ComfyValues values;
  values.prompt = "a {seed} {negative_prompt} \" }";
  values.negative_prompt = "no placeholder";
  values.seed = 7;
  const simwright::core::OrderedJson filled = FilledWorkflow(workflow, values);
  if (filled.size() != workflow.size()) std::abort();
  // Nothing but the prompt's own words may look like placeholders afterwards.
  for (std::string* value : {&values.prompt, &values.negative_prompt, &values.render, &values.mask,
                             &values.depth, &values.exemplar, &values.checkpoint}) {
    *value = "#";
  }
  if (HasPlaceholder(FilledWorkflow(workflow, values), "negative_prompt")) std::abort();
}

void WriteAForm(const std::string& text) {
  const MultipartForm form = MakeMultipartForm({{"image", text, "a.png", "image/png"}});
  const std::string boundary = form.content_type.substr(form.content_type.find('=') + 1);
  if (text.find(boundary) != std::string::npos) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      ReadAnAnswer(text);
      break;
    case 1:
      FillAWorkflow(text);
      break;
    default:
      WriteAForm(text);
  }
  return 0;
}
