#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base64.h"
#include "core/error.h"
#include "core/json.h"
#include "texture/endpoints/endpoint_generators.h"
#include "texture/endpoints/endpoint_picture.h"
#include "texture/endpoints/multipart_form.h"

namespace simwright::texture {
namespace {

constexpr const char* kDefaultModel = "gpt-image-1";

struct PictureSize {
  int width, height;
};
// The sizes of OpenAI's models (API reference of images, 2025).
constexpr std::array<PictureSize, 3> kGptImageSizes = {
    PictureSize{1024, 1024}, {1536, 1024}, {1024, 1536}};
constexpr std::array<PictureSize, 3> kDallE2Sizes = {
    PictureSize{256, 256}, {512, 512}, {1024, 1024}};
constexpr std::array<PictureSize, 3> kDallE3Sizes = {
    PictureSize{1024, 1024}, {1792, 1024}, {1024, 1792}};

// Asks OpenAI's images/generations, or images/edits with a mask.
class OpenAiImageGenerator final : public ImageGenerator {
 public:
  explicit OpenAiImageGenerator(EndpointConnection connection)
      : connection_(std::move(connection)) {
    model_ = connection_.options().model.empty() ? kDefaultModel : connection_.options().model;
  }

  std::string name() const override { return "openai " + connection_.shown(); }
  core::Findings TakeFindings() override { return connection_.TakeFindings(); }
  core::Image Generate(const ImageRequest& request) override;

 private:
  bool IsGptImage() const { return model_.starts_with("gpt-image"); }
  PictureSize SizeFor(int width, int height) const;
  std::string AskByWords(const ImageRequest& request, const PictureSize& size);
  std::string AskForEdit(const ImageRequest& request, const PictureSize& size,
                         const Canvas& canvas);
  std::string PictureBytes(const std::string& answer);

  EndpointConnection connection_;
  std::string model_;
};

// Returns the model's size with the nearest aspect ratio, among these the smallest one that is no
// smaller, else the largest; other models get the requested size.
PictureSize OpenAiImageGenerator::SizeFor(int width, int height) const {
  const std::array<PictureSize, 3>* sizes = nullptr;
  if (IsGptImage()) sizes = &kGptImageSizes;
  if (model_ == "dall-e-2") sizes = &kDallE2Sizes;
  if (model_ == "dall-e-3") sizes = &kDallE3Sizes;
  if (sizes == nullptr) return {width, height};
  const auto misfit = [&](const PictureSize& size) {
    const double aspect = std::abs(
        std::log(static_cast<double>(size.width) / size.height * height / std::max(width, 1)));
    const double scale = std::log(static_cast<double>(size.width) / std::max(width, 1));
    // The aspect ratio comes first; a picture that is too small is worse than one too large.
    return 100.0 * aspect + (scale < 0.0 ? -10.0 * scale : scale);
  };
  PictureSize best = sizes->front();
  for (const PictureSize& size : *sizes) {
    if (misfit(size) < misfit(best)) best = size;
  }
  return best;
}

std::string PromptText(const ImageRequest& request) {
  if (request.negative_prompt.empty()) return request.prompt;
  return request.prompt + "\nAvoid: " + request.negative_prompt;
}

std::string SizeField(const PictureSize& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string OpenAiImageGenerator::AskByWords(const ImageRequest& request, const PictureSize& size) {
  core::OrderedJson body = {
      {"model", model_}, {"prompt", PromptText(request)}, {"n", 1}, {"size", SizeField(size)}};
  // OpenAI's newer models always answer in Base64 and refuse the field.
  if (!IsGptImage()) body["response_format"] = "b64_json";
  return connection_.Post("/images/generations", "application/json",
                          core::JsonLine(body, core::InvalidUtf8::kReplace));
}

// Returns the mask of an edit: RGBA, transparent where the picture is to be repainted.
core::Image EditMask(const ImageRequest& request, const Canvas& canvas) {
  const core::Image mask = InpaintingMask(request, canvas);
  core::Image edit(canvas.width, canvas.height, 4, 255);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    edit.pixels[4 * i + 3] = static_cast<std::uint8_t>(255 - mask.pixels[i]);
  }
  return edit;
}

std::string OpenAiImageGenerator::AskForEdit(const ImageRequest& request, const PictureSize& size,
                                             const Canvas& canvas) {
  const bool view = !request.render.empty();
  const bool several = view && !request.exemplar.empty();
  const char* const picture = several ? "image[]" : "image";
  std::vector<FormField> fields = {
      {"model", model_}, {"prompt", PromptText(request)}, {"n", "1"}, {"size", SizeField(size)}};
  if (!IsGptImage()) fields.push_back({"response_format", "b64_json"});
  const auto add_png = [&](const char* name, const core::Image& image, const char* file) {
    fields.push_back({name, core::EncodePng(image), file, "image/png"});
  };
  // The mask is of the first picture.
  if (view) {
    add_png(picture, PaddedRender(request, canvas), "render.png");
    add_png("mask", EditMask(request, canvas), "mask.png");
  }
  if (!request.exemplar.empty()) add_png(picture, request.exemplar, "exemplar.png");
  const MultipartForm form = MakeMultipartForm(fields);
  return connection_.Post("/images/edits", form.content_type, form.body);
}

std::string OpenAiImageGenerator::PictureBytes(const std::string& answer) {
  const std::optional<core::Json> json = core::TryParseJson(answer);
  const core::Json* data = json ? core::FindMember(*json, "data") : nullptr;
  if (data == nullptr || !data->is_array() || data->empty()) {
    const std::string message = MessageInAnswer(answer);
    if (!message.empty()) connection_.FailWithMessage(message);
    connection_.Fail("its answer is " + connection_.Clean(DescribeAnswer(answer), 200) +
                         ", expected JSON with a picture in \"data\"",
                     "check the address, which usually ends in /v1, and --dialect");
  }
  const std::string base64 = core::TextMember(data->front(), "b64_json");
  if (!base64.empty()) {
    const std::optional<std::string> bytes = core::FromBase64(base64);
    if (!bytes) connection_.Fail("its picture is not Base64");
    return *bytes;
  }
  const std::string url = core::TextMember(data->front(), "url");
  if (url.empty()) connection_.Fail("its answer has neither a picture nor the address of one");
  return connection_.Fetch(url);
}

core::Image OpenAiImageGenerator::Generate(const ImageRequest& request) {
  RequirePrompt(request, connection_);
  connection_.Begin();
  const bool view = !request.render.empty();
  connection_.Report("image-seed-unused", core::Severity::kInfo,
                     "OpenAI's protocol has no seed: the same request gives another picture");
  if (view) {
    connection_.Report("image-depth-unused", core::Severity::kWarning,
                       "OpenAI's protocol takes no depth, so that its pictures may disagree with "
                       "the shape");
  }
  Canvas canvas = CanvasOf(request, 1);
  const PictureSize size = SizeFor(canvas.width, canvas.height);
  if (view) canvas = CanvasOfAspect(request, size.width, size.height);
  const std::string answer = view || !request.exemplar.empty() ? AskForEdit(request, size, canvas)
                                                               : AskByWords(request, size);
  return AnsweredPicture(PictureBytes(answer), request, canvas, &connection_);
}

}  // namespace

std::unique_ptr<ImageGenerator> MakeOpenAiImageGenerator(EndpointConnection connection) {
  return std::make_unique<OpenAiImageGenerator>(std::move(connection));
}

}  // namespace simwright::texture
