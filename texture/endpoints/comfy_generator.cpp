#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "texture/endpoints/comfy_graph.h"
#include "texture/endpoints/endpoint_generators.h"
#include "texture/endpoints/endpoint_picture.h"
#include "texture/endpoints/multipart_form.h"

namespace simwright::texture {
namespace {

constexpr int kComfyMultiple = 8;  // pixels of a latent cell
constexpr std::uint64_t kLargestWorkflow = 16u << 20;

// Asks ComfyUI: uploads the pictures, queues a workflow, polls its history, fetches the picture.
class ComfyGenerator final : public ImageGenerator {
 public:
  explicit ComfyGenerator(EndpointConnection connection);

  std::string name() const override { return "comfyui " + connection_.shown(); }
  core::Findings TakeFindings() override { return connection_.TakeFindings(); }
  core::Image Generate(const ImageRequest& request) override;

 private:
  std::string Upload(const core::Image& image);
  bool Uses(const char* placeholder) const {
    return workflow_.is_null() || HasPlaceholder(workflow_, placeholder);
  }
  void UploadView(const ImageRequest& request, const Canvas& canvas, ComfyValues* values);
  void FindModels(bool view);
  std::vector<std::string> Choices(const std::string& node, const std::string& input);
  std::string Queue(const core::OrderedJson& workflow);
  std::string WaitForPicture(const std::string& id);

  EndpointConnection connection_;
  core::OrderedJson workflow_;  // the user's; null: ours
  std::optional<std::string> checkpoint_, depth_model_;
};

ComfyGenerator::ComfyGenerator(EndpointConnection connection) : connection_(std::move(connection)) {
  const std::filesystem::path& file = connection_.options().workflow;
  if (file.empty()) return;
  workflow_ = core::ParseOrderedJson(core::ReadFile(file, kLargestWorkflow), file.string());
  const auto is_node = [](const core::OrderedJson& node) {
    return node.is_object() && node.contains("class_type") && node.contains("inputs");
  };
  if (!workflow_.is_object() || workflow_.empty() ||
      !std::all_of(workflow_.begin(), workflow_.end(), is_node)) {
    throw core::Error("is no workflow in ComfyUI's API format", file.string(),
                      "export it with \"Save (API Format)\"");
  }
  if (!HasPlaceholder(workflow_, "prompt")) {
    throw core::Error("has no placeholder {prompt}", file.string(),
                      "write {prompt} where the workflow has the text");
  }
}

// Returns the values that a node offers for an input, e.g. the files of checkpoints.
std::vector<std::string> ComfyGenerator::Choices(const std::string& node,
                                                 const std::string& input) {
  std::vector<std::string> names;
  const std::optional<core::Json> json =
      core::TryParseJson(connection_.Get("/object_info/" + node));
  const core::Json* member = json ? core::FindMember(*json, node.c_str()) : nullptr;
  for (const char* name : {"input", "required", input.c_str()}) {
    if (member != nullptr) member = core::FindMember(*member, name);
  }
  if (member == nullptr || !member->is_array() || member->empty()) return names;
  // [[names], {...}], and since 2025 also ["COMBO", {"options": [names]}].
  const core::Json* list = &member->front();
  if (!list->is_array() && member->size() > 1) list = core::FindMember((*member)[1], "options");
  if (list == nullptr || !list->is_array()) return names;
  for (const core::Json& name : *list) {
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

void ComfyGenerator::FindModels(bool view) {
  const ImageGeneratorOptions& options = connection_.options();
  if (!checkpoint_ && Uses("checkpoint")) {
    checkpoint_ = options.model;
    if (checkpoint_->empty()) {
      const std::vector<std::string> names = Choices("CheckpointLoaderSimple", "ckpt_name");
      if (names.empty()) {
        connection_.Fail("the server has no checkpoint", "put one into its models/checkpoints");
      }
      checkpoint_ = names.front();
      if (names.size() > 1) {
        connection_.Report("image-model-chosen", core::Severity::kInfo,
                           "of " + std::to_string(names.size()) + " checkpoints the first was " +
                               "taken: " + connection_.Clean(names.front(), 80),
                           static_cast<double>(names.size()));
      }
    }
  }
  if (!view || depth_model_ || !workflow_.is_null()) return;
  depth_model_ = options.depth_model;
  if (!depth_model_->empty()) return;
  for (const std::string& name : Choices("ControlNetLoader", "control_net_name")) {
    if (depth_model_->empty() && name.find("depth") != std::string::npos) depth_model_ = name;
  }
  if (depth_model_->empty()) {
    connection_.Report("image-depth-unused", core::Severity::kWarning,
                       "the server has no ControlNet model for depth, so that its pictures may "
                       "disagree with the shape");
  }
}

// Uploads a picture under a name of its content, so that equal ones are stored once, and returns
// the name by which workflows load it.
std::string ComfyGenerator::Upload(const core::Image& image) {
  const std::string png = core::EncodePng(image);
  const MultipartForm form = MakeMultipartForm(
      {{"type", "input"},
       {"overwrite", "true"},
       {"image", png, "simwright_" + core::ContentHash(png).substr(0, 16) + ".png", "image/png"}});
  const std::string answer = connection_.Post("/upload/image", form.content_type, form.body);
  const std::optional<core::Json> json = core::TryParseJson(answer);
  const std::string name = json ? core::TextMember(*json, "name") : "";
  if (name.empty()) {
    connection_.Fail("its answer to an upload is " + connection_.Clean(DescribeAnswer(answer), 200),
                     "check the address and --dialect");
  }
  const std::string folder = core::TextMember(*json, "subfolder");
  return folder.empty() ? name : folder + "/" + name;
}

void ComfyGenerator::UploadView(const ImageRequest& request, const Canvas& canvas,
                                ComfyValues* values) {
  if (!request.render.empty()) {
    if (!Uses("render")) {
      connection_.Fail("the workflow has no placeholder {render}, so that it cannot paint a view",
                       "use a workflow that inpaints {render} inside {mask}");
    }
    values->render = Upload(PaddedRender(request, canvas));
    if (Uses("mask")) {
      const core::Image mask = InpaintingMask(request, canvas);
      core::Image rgb(mask.width, mask.height, 3);
      for (std::size_t i = 0; i < rgb.pixels.size(); ++i) rgb.pixels[i] = mask.pixels[i / 3];
      values->mask = Upload(rgb);
    }
    if (workflow_.is_null() ? !values->depth_model.empty() : Uses("depth")) {
      values->depth = Upload(InverseDepthPicture(request, canvas));
    }
  }
  if (request.exemplar.empty()) return;
  if (!workflow_.is_null() && Uses("exemplar")) {
    values->exemplar = Upload(request.exemplar);
  } else {
    connection_.Report("image-exemplar-unused", core::Severity::kWarning,
                       "the workflow has no placeholder {exemplar}; the exemplar is not sent");
  }
}

std::string ComfyGenerator::Queue(const core::OrderedJson& workflow) {
  core::OrderedJson body;
  body["prompt"] = workflow;
  body["client_id"] = "simwright";
  const std::string answer = connection_.Post("/prompt", "application/json",
                                              core::JsonLine(body, core::InvalidUtf8::kReplace));
  const std::optional<core::Json> json = core::TryParseJson(answer);
  const std::string id = json ? core::TextMember(*json, "prompt_id") : "";
  const bool plain = !id.empty() && id.size() <= 100 &&
                     std::all_of(id.begin(), id.end(),
                                 [](unsigned char c) { return std::isalnum(c) || c == '-'; });
  if (plain) return id;
  const std::string message = MessageInAnswer(answer);
  if (!message.empty()) connection_.FailWithMessage(message);
  connection_.Fail("its answer to a workflow is " + connection_.Clean(DescribeAnswer(answer), 200),
                   "check the address and --dialect");
}

// Returns the first picture of the outputs as the query of /view; "" if there is none.
std::string FirstPicture(const core::Json& outputs) {
  const auto escaped = [](const std::string& text) {
    std::string result;
    for (const unsigned char c : text) {
      if (std::isalnum(c) || c == '.' || c == '-' || c == '_') {
        result += static_cast<char>(c);
      } else {
        constexpr const char* kHex = "0123456789ABCDEF";
        result += {'%', kHex[c >> 4], kHex[c & 15]};
      }
    }
    return result;
  };
  if (!outputs.is_object()) return "";
  for (const core::Json& output : outputs) {
    const core::Json* images = core::FindMember(output, "images");
    if (images == nullptr || !images->is_array() || images->empty()) continue;
    const std::string file = core::TextMember(images->front(), "filename");
    if (file.empty()) continue;
    const std::string type = core::TextMember(images->front(), "type");
    return "filename=" + escaped(file) +
           "&subfolder=" + escaped(core::TextMember(images->front(), "subfolder")) +
           "&type=" + escaped(type.empty() ? "output" : type);
  }
  return "";
}

// Returns the message of a failed execution in ComfyUI's history; "" if it did not fail.
std::string ExecutionError(const core::Json& entry) {
  const core::Json* status = core::FindMember(entry, "status");
  if (status == nullptr || core::TextMember(*status, "status_str") != "error") return "";
  const core::Json* messages = core::FindMember(*status, "messages");
  if (messages != nullptr && messages->is_array()) {
    for (const core::Json& message : *messages) {
      if (!message.is_array() || message.size() < 2) continue;
      const std::string text = core::TextMember(message[1], "exception_message");
      if (!text.empty()) {
        return text + " (node " + core::TextMember(message[1], "node_type") + ")";
      }
    }
  }
  return "the workflow failed";
}

std::string ComfyGenerator::WaitForPicture(const std::string& id) {
  for (;;) {
    const std::string answer = connection_.Get("/history/" + id);
    const std::optional<core::Json> json = core::TryParseJson(answer);
    if (!json || !json->is_object()) {
      connection_.Fail("its history is " + connection_.Clean(DescribeAnswer(answer), 200));
    }
    if (const core::Json* entry = core::FindMember(*json, id.c_str())) {
      const std::string error = ExecutionError(*entry);
      if (!error.empty()) connection_.FailWithMessage(error);
      const core::Json* outputs = core::FindMember(*entry, "outputs");
      const std::string picture = outputs == nullptr ? "" : FirstPicture(*outputs);
      if (!picture.empty()) return connection_.Get("/view?" + picture);
      connection_.Fail("the workflow made no picture",
                       "end it in a node SaveImage or PreviewImage");
    }
    connection_.Sleep(connection_.options().poll_wait);
  }
}

core::Image ComfyGenerator::Generate(const ImageRequest& request) {
  RequirePrompt(request, connection_);
  connection_.Begin();
  const ImageGeneratorOptions& options = connection_.options();
  const Canvas canvas = CanvasOf(request, kComfyMultiple);
  FindModels(!request.render.empty());
  ComfyValues values;
  values.prompt = request.prompt;
  values.negative_prompt = request.negative_prompt;
  values.checkpoint = checkpoint_.value_or("");
  values.depth_model = depth_model_.value_or("");
  values.width = canvas.width;
  values.height = canvas.height;
  values.steps = options.steps;
  values.guidance = options.guidance;
  values.denoising_strength = options.denoising_strength;
  values.seed = SamplerSeed(request.seed);
  UploadView(request, canvas, &values);
  const std::string id =
      Queue(workflow_.is_null() ? ComfyGraph(values) : FilledWorkflow(workflow_, values));
  return AnsweredPicture(WaitForPicture(id), request, canvas, &connection_);
}

}  // namespace

std::unique_ptr<ImageGenerator> MakeComfyGenerator(EndpointConnection connection) {
  return std::make_unique<ComfyGenerator>(std::move(connection));
}

}  // namespace simwright::texture
