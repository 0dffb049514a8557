#include <optional>
#include <utility>

#include "core/base64.h"
#include "core/error.h"
#include "core/json.h"
#include "texture/endpoints/endpoint_generators.h"
#include "texture/endpoints/endpoint_picture.h"

namespace simwright::texture {
namespace {

constexpr int kLatentMultiple = 8;  // pixels of a latent cell
constexpr int kFillWithOriginal = 1;

// Asks Stable Diffusion web UI: txt2img, or img2img with a mask and ControlNet's depth.
class WebUiGenerator final : public ImageGenerator {
 public:
  explicit WebUiGenerator(EndpointConnection connection) : connection_(std::move(connection)) {}

  std::string name() const override { return "sdwebui " + connection_.shown(); }
  core::Findings TakeFindings() override { return connection_.TakeFindings(); }
  core::Image Generate(const ImageRequest& request) override;

 private:
  core::OrderedJson Body(const ImageRequest& request, const Canvas& canvas);
  void AddView(const ImageRequest& request, const Canvas& canvas, core::OrderedJson* body);
  std::string DepthModel();

  EndpointConnection connection_;
  std::optional<std::string> depth_model_;  // found; empty: the server has none
};

// Returns the name of ControlNet's depth model; "" if the server has none.
std::string WebUiGenerator::DepthModel() {
  if (!connection_.options().depth_model.empty()) return connection_.options().depth_model;
  if (depth_model_) return *depth_model_;
  depth_model_ = "";
  const llm::HttpReply reply = connection_.Probe("/controlnet/model_list");
  const std::optional<core::Json> json = core::TryParseJson(reply.body);
  const core::Json* models = json ? core::FindMember(*json, "model_list") : nullptr;
  if (reply.status == 200 && models != nullptr && models->is_array()) {
    for (const core::Json& model : *models) {
      if (!model.is_string()) continue;
      const std::string name = model.get<std::string>();
      if (name.find("depth") == std::string::npos) continue;
      depth_model_ = name;
      break;
    }
  }
  if (depth_model_->empty()) {
    connection_.Report("image-depth-unused", core::Severity::kWarning,
                       "the server has no ControlNet model for depth, so that its pictures may "
                       "disagree with the shape");
  }
  return *depth_model_;
}

core::OrderedJson WebUiGenerator::Body(const ImageRequest& request, const Canvas& canvas) {
  const ImageGeneratorOptions& options = connection_.options();
  core::OrderedJson body = {{"prompt", request.prompt},
                            {"negative_prompt", request.negative_prompt},
                            {"seed", SamplerSeed(request.seed)},
                            {"width", canvas.width},
                            {"height", canvas.height},
                            {"steps", options.steps},
                            {"cfg_scale", options.guidance},
                            {"batch_size", 1},
                            {"n_iter", 1},
                            {"send_images", true},
                            {"save_images", false}};
  if (!options.model.empty()) {
    body["override_settings"] = {{"sd_model_checkpoint", options.model}};
  }
  return body;
}

void WebUiGenerator::AddView(const ImageRequest& request, const Canvas& canvas,
                             core::OrderedJson* body) {
  const auto base64 = [](const core::Image& image) { return core::Base64(core::EncodePng(image)); };
  (*body)["init_images"] = core::OrderedJson::array({base64(PaddedRender(request, canvas))});
  (*body)["mask"] = base64(InpaintingMask(request, canvas));
  (*body)["mask_blur"] = 0;
  (*body)["inpainting_fill"] = kFillWithOriginal;
  (*body)["inpaint_full_res"] = false;
  (*body)["inpainting_mask_invert"] = 0;
  (*body)["denoising_strength"] = connection_.options().denoising_strength;
  const std::string model = DepthModel();
  if (model.empty()) return;
  const core::OrderedJson unit = {{"enabled", true},
                                  {"module", "none"},
                                  {"model", model},
                                  {"weight", 1.0},
                                  {"image", base64(InverseDepthPicture(request, canvas))},
                                  {"resize_mode", "Just Resize"},
                                  {"control_mode", "Balanced"},
                                  {"pixel_perfect", false},
                                  {"guidance_start", 0.0},
                                  {"guidance_end", 1.0}};
  (*body)["alwayson_scripts"]["ControlNet"]["args"] = core::OrderedJson::array({unit});
}

core::Image WebUiGenerator::Generate(const ImageRequest& request) {
  RequirePrompt(request, connection_);
  connection_.Begin();
  if (!request.exemplar.empty()) {
    connection_.Report("image-exemplar-unused", core::Severity::kWarning,
                       "the web UI is asked by words alone; the exemplar is not sent");
  }
  const Canvas canvas = CanvasOf(request, kLatentMultiple);
  core::OrderedJson body = Body(request, canvas);
  const bool view = !request.render.empty();
  if (view) AddView(request, canvas, &body);
  const std::string answer =
      connection_.Post(view ? "/sdapi/v1/img2img" : "/sdapi/v1/txt2img", "application/json",
                       core::JsonLine(body, core::InvalidUtf8::kReplace));
  const std::optional<core::Json> json = core::TryParseJson(answer);
  const core::Json* images = json ? core::FindMember(*json, "images") : nullptr;
  if (images == nullptr || !images->is_array() || images->empty() || !images->front().is_string()) {
    const std::string message = MessageInAnswer(answer);
    if (!message.empty()) connection_.FailWithMessage(message);
    connection_.Fail("its answer is " + connection_.Clean(DescribeAnswer(answer), 200) +
                         ", expected JSON with a picture in \"images\"",
                     "check the address and --dialect");
  }
  // ControlNet's maps follow the picture in the list.
  std::string text = images->front().get<std::string>();
  const std::size_t comma = text.find(',');
  if (text.starts_with("data:") && comma != std::string::npos) text.erase(0, comma + 1);
  const std::optional<std::string> bytes = core::FromBase64(text);
  if (!bytes) connection_.Fail("its picture is not Base64");
  return AnsweredPicture(*bytes, request, canvas, &connection_);
}

}  // namespace

std::unique_ptr<ImageGenerator> MakeWebUiGenerator(EndpointConnection connection) {
  return std::make_unique<WebUiGenerator>(std::move(connection));
}

}  // namespace simwright::texture
