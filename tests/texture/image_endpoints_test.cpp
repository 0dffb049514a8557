// Image servers: what arrives at real servers of each dialect, and what becomes of bad answers.
#include <gtest/gtest.h>

#include <fstream>

#include "core/files.h"
#include "llm/http_client.h"

#include "tests/texture/image_server.h"  // last: see there

namespace simwright::texture {
namespace {

// A web UI with or without ControlNet, which answers with `picture`.
ImageServer::Handler WebUi(const core::Image& picture, bool control_net = true) {
  return [=](const httplib::Request& request, httplib::Response& response) {
    if (request.path == "/sdapi/v1/samplers") {
      response.set_content("[{\"name\": \"Euler\"}]", "application/json");
    } else if (request.path == "/controlnet/model_list" && control_net) {
      response.set_content(
          R"({"model_list": ["control_canny [1]", "control_v11f1p_sd15_depth [cfd03158]"]})",
          "application/json");
    } else if (request.path == "/sdapi/v1/txt2img" || request.path == "/sdapi/v1/img2img") {
      response.set_content(nlohmann::json{{"images", {PngBase64(picture)}}, {"info", "{}"}}.dump(),
                           "application/json");
    } else {
      response.status = 404;
      response.set_content(R"({"detail": "Not Found"})", "application/json");
    }
  };
}

TEST(ImageEndpoints, WebUiMakesPicturesOfWords) {
  const core::Image picture = RampPicture(128, 96);
  ImageServer server(WebUi(picture));
  llm::StillClock clock;
  const auto generator =
      MakeImageGenerator(ImagesFrom(server.origin(), ImageDialect::kAuto), clock);
  EXPECT_EQ(generator->name(), "sdwebui " + server.origin() + "/");
  EXPECT_EQ(generator->Generate(WordsRequest()).pixels, picture.pixels);
  const SeenImageRequest seen = server.SeenAt("/sdapi/v1/txt2img").at(0);
  EXPECT_EQ(seen.authorization, std::string("Bearer ") + kImageKey);
  const nlohmann::json body = nlohmann::json::parse(seen.body);
  EXPECT_EQ(body.at("prompt"), "a red \"apple\" on white");
  EXPECT_EQ(body.at("negative_prompt"), "hands");
  EXPECT_EQ(body.at("seed"), 42);
  EXPECT_EQ(body.at("width"), 128);
  EXPECT_EQ(body.at("height"), 96);
  EXPECT_FALSE(body.contains("init_images"));
  EXPECT_TRUE(generator->TakeFindings().empty());
}

TEST(ImageEndpoints, WebUiInpaintsAViewUnderItsDepth) {
  // 100 x 60 pixels are padded to 104 x 64, of which the answer is cropped.
  const core::Image picture = RampPicture(104, 64);
  ImageServer server(WebUi(picture));
  llm::StillClock clock;
  ImageGeneratorOptions options = ImagesFrom(server.origin(), ImageDialect::kSdWebUi);
  options.denoising_strength = 0.75;
  options.model = "sd15.safetensors";
  const auto generator = MakeImageGenerator(options, clock);
  const ImageRequest request = ViewRequest(100, 60);
  const core::Image answer = generator->Generate(request);
  ASSERT_EQ(answer.width, 100);
  ASSERT_EQ(answer.height, 60);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(answer.At(10, 20)[c], picture.At(12, 22)[c]);

  const nlohmann::json body = nlohmann::json::parse(server.SeenAt("/sdapi/v1/img2img").at(0).body);
  EXPECT_EQ(body.at("denoising_strength"), 0.75);
  EXPECT_EQ(body.at("override_settings").at("sd_model_checkpoint"), "sd15.safetensors");
  const core::Image render = FromPngBase64(body.at("init_images").at(0));
  ASSERT_EQ(render.width, 104);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(render.At(2 + 50, 2 + 30)[c], request.render.At(50, 30)[c]);
  const core::Image mask = FromPngBase64(body.at("mask"));
  EXPECT_EQ(*mask.At(2 + 10, 30), 0);    // kept
  EXPECT_EQ(*mask.At(2 + 50, 30), 255);  // refined
  EXPECT_EQ(*mask.At(2 + 90, 30), 255);  // generated
  EXPECT_EQ(*mask.At(103, 30), 0);       // margin
  const nlohmann::json unit = body.at("alwayson_scripts").at("ControlNet").at("args").at(0);
  EXPECT_EQ(unit.at("model"), "control_v11f1p_sd15_depth [cfd03158]");
  EXPECT_EQ(unit.at("module"), "none");
  const core::Image depth = FromPngBase64(unit.at("image"));
  EXPECT_EQ(depth.At(50, 2)[0], 0);         // nothing in the first row
  EXPECT_EQ(depth.At(50, 2 + 10)[0], 255);  // 2 m, the nearest
  EXPECT_EQ(depth.At(50, 2 + 50)[0], 64);   // 4 m, the farthest
}

TEST(ImageEndpoints, WebUiWithoutControlNetSaysSo) {
  ImageServer server(WebUi(RampPicture(48, 32), false));
  llm::StillClock clock;
  const auto generator =
      MakeImageGenerator(ImagesFrom(server.origin(), ImageDialect::kSdWebUi), clock);
  ImageRequest request = ViewRequest(96, 64);
  request.exemplar = RampPicture(20, 20);
  EXPECT_EQ(generator->Generate(request).width, 96);
  const nlohmann::json body = nlohmann::json::parse(server.SeenAt("/sdapi/v1/img2img").at(0).body);
  EXPECT_FALSE(body.contains("alwayson_scripts"));
  const core::Findings findings = generator->TakeFindings();
  EXPECT_TRUE(HasFinding(findings, "image-depth-unused"));
  EXPECT_TRUE(HasFinding(findings, "image-exemplar-unused"));
  EXPECT_TRUE(HasFinding(findings, "image-resized"));  // 48 x 32 came for 96 x 64
  generator->Generate(request);
  EXPECT_TRUE(generator->TakeFindings().empty());  // reported once
}

// A ComfyUI whose picture is ready at the third question.
class Comfy {
 public:
  explicit Comfy(const core::Image& picture) : picture_(core::EncodePng(picture)) {}

  void operator()(const httplib::Request& request, httplib::Response& response) {
    const auto json = [&](const std::string& content) {
      response.set_content(content, "application/json");
    };
    if (request.path == "/system_stats") return json(R"({"system": {"os": "posix"}})");
    if (request.path == "/object_info/CheckpointLoaderSimple") {
      return json(R"({"CheckpointLoaderSimple": {"input": {"required":
        {"ckpt_name": [["a.safetensors", "b.ckpt"], {}]}}}})");
    }
    if (request.path == "/object_info/ControlNetLoader") {
      return json(R"({"ControlNetLoader": {"input": {"required":
        {"control_net_name": ["COMBO", {"options": ["canny.pth", "depth_sd15.pth"]}]}}}})");
    }
    if (request.path == "/upload/image") {
      return json(R"({"subfolder": "in", "name": ")" + request.get_file_value("image").filename +
                  "\"}");
    }
    if (request.path == "/prompt") return json(R"({"prompt_id": "12-ab", "node_errors": {}})");
    if (request.path == "/history/12-ab") {
      if (polls_++ < 2) return json("{}");
      return json(R"({"12-ab": {"status": {"status_str": "success"}, "outputs": {
        "text": {"text": ["x"]}, "picture": {"images":
        [{"filename": "a b.png", "subfolder": "", "type": "temp"}]}}}})");
    }
    if (request.path == "/view" && request.get_param_value("filename") == "a b.png" &&
        request.get_param_value("type") == "temp") {
      return response.set_content(picture_, "image/png");
    }
    response.status = 404;
  }

 private:
  std::string picture_;
  int polls_ = 0;
};

TEST(ImageEndpoints, ComfyUiRunsAWorkflowOfOurs) {
  const core::Image picture = RampPicture(96, 64);
  ImageServer server{Comfy(picture)};
  llm::StillClock clock;
  const auto generator =
      MakeImageGenerator(ImagesFrom(server.origin(), ImageDialect::kAuto), clock);
  EXPECT_EQ(generator->name(), "comfyui " + server.origin() + "/");
  const ImageRequest request = ViewRequest();
  EXPECT_EQ(generator->Generate(request).pixels, picture.pixels);
  EXPECT_EQ(clock.sleeps.size(), 2u);  // polled twice in vain

  const std::vector<SeenImageRequest> uploads = server.SeenAt("/upload/image");
  ASSERT_EQ(uploads.size(), 3u);
  const auto upload = [&](std::size_t number) {
    return core::DecodeImage(uploads.at(number).files.find("image")->second.content, "upload");
  };
  EXPECT_EQ(upload(0).pixels, request.render.pixels);
  EXPECT_EQ(upload(1).At(10, 30)[0], 0);
  EXPECT_EQ(upload(1).At(50, 30)[0], 255);
  EXPECT_EQ(upload(2).At(50, 40)[0], 64);

  const nlohmann::json graph =
      nlohmann::json::parse(server.SeenAt("/prompt").at(0).body).at("prompt");
  // Every input that is [node, output] names a node of the graph.
  for (const auto& [id, node] : graph.items()) {
    for (const auto& [name, input] : node.at("inputs").items()) {
      if (!input.is_array()) continue;
      EXPECT_TRUE(graph.contains(input.at(0).get<std::string>())) << id << "." << name;
    }
  }
  const nlohmann::json sampler = graph.at("sampler").at("inputs");
  EXPECT_EQ(sampler.at("seed"), 42);
  EXPECT_EQ(graph.at("checkpoint").at("inputs").at("ckpt_name"), "a.safetensors");
  EXPECT_EQ(graph.at("control_net").at("inputs").at("control_net_name"), "depth_sd15.pth");
  EXPECT_EQ(graph.at(sampler.at("positive").at(0)).at("class_type"), "ControlNetApplyAdvanced");
  EXPECT_EQ(graph.at(sampler.at("latent_image").at(0)).at("class_type"), "SetLatentNoiseMask");
  EXPECT_EQ(graph.at("positive").at("inputs").at("text"), "a red \"apple\" on white");
  EXPECT_EQ(graph.at("render").at("inputs").at("image").get<std::string>().substr(0, 13),
            "in/simwright_");
  EXPECT_TRUE(HasFinding(generator->TakeFindings(), "image-model-chosen"));
}

TEST(ImageEndpoints, ComfyUiRunsTheUsersWorkflow) {
  const core::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "workflow.json";
  std::ofstream(file) << R"({"3": {"class_type": "KSampler", "inputs": {"seed": "{seed}",
    "note": "photo of {prompt}, {width} wide"}}, "9": {"class_type": "Flux", "inputs": {}}})";
  ImageServer server{Comfy(RampPicture(128, 96))};
  llm::StillClock clock;
  ImageGeneratorOptions options = ImagesFrom(server.origin(), ImageDialect::kComfyUi);
  options.workflow = file;
  ImageRequest request = WordsRequest();
  request.prompt = "a {seed} \" }";  // is data: no placeholder in it is filled
  MakeImageGenerator(options, clock)->Generate(request);
  const nlohmann::json inputs =
      nlohmann::json::parse(server.SeenAt("/prompt").at(0).body).at("prompt").at("3").at("inputs");
  EXPECT_EQ(inputs.at("seed"), 42);
  EXPECT_EQ(inputs.at("note"), "photo of a {seed} \" }, 128 wide");
  ExpectPart("no placeholder {render}", PictureFailure(options, ViewRequest()));
  std::ofstream(file) << R"({"nodes": []})";
  ExpectPart("no workflow in ComfyUI's API format", PictureFailure(options));
}

TEST(ImageEndpoints, ComfyUiTellsWhyAWorkflowFailed) {
  std::string history, refusal;
  ImageServer server([&](const httplib::Request& request, httplib::Response& response) {
    if (request.path == "/prompt" && !refusal.empty()) response.status = 400;
    const std::string prompt = refusal.empty() ? R"({"prompt_id": "1"})" : refusal;
    response.set_content(request.path == "/prompt" ? prompt : history, "application/json");
  });
  ImageGeneratorOptions options = ImagesFrom(server.origin(), ImageDialect::kComfyUi);
  options.model = "a.safetensors";
  history = R"({"1": {"status": {"status_str": "error", "messages": [["execution_start", {}],
    ["execution_error", {"exception_message": "CUDA out of memory", "node_type": "KSampler"}]]}}})";
  ExpectPart("CUDA out of memory (node KSampler)", PictureFailure(options));
  history = R"({"1": {"status": {"status_str": "success"}, "outputs": {}}})";
  ExpectPart("made no picture", PictureFailure(options));
  history = "{}";  // queued for ever
  ExpectPart("no picture arrived within 60 s", PictureFailure(options));
  refusal = R"({"error": {"message": "Prompt outputs failed validation", "details": ""},
    "node_errors": {"4": {"errors": [{"message": "Value not in list", "details": "a.ckpt"}]}}})";
  ExpectPart("Prompt outputs failed validation; Value not in list: a.ckpt",
             PictureFailure(options));
  for (const char* id : {R"({"prompt_id": "../../etc"})", R"({"prompt_id": 3})"}) {
    refusal.clear();
    ImageServer odd([&](const httplib::Request&, httplib::Response& response) {
      response.set_content(id, "application/json");
    });
    options.url = odd.origin();
    ExpectPart("its answer to a workflow is", PictureFailure(options));
    EXPECT_EQ(odd.seen().size(), 1u);
  }
}

TEST(ImageEndpoints, OpenAiMakesPicturesOfWords) {
  const core::Image picture = RampPicture(1536, 1024);
  ImageServer server([&](const httplib::Request& request, httplib::Response& response) {
    if (request.path == "/v1/models") {
      response.set_content(R"({"object": "list", "data": []})", "application/json");
    } else if (request.path == "/v1/images/generations") {
      response.set_content(nlohmann::json{{"data", {{{"b64_json", PngBase64(picture)}}}}}.dump(),
                           "application/json");
    } else {
      response.status = 404;
    }
  });
  llm::StillClock clock;
  const auto generator =
      MakeImageGenerator(ImagesFrom(server.origin() + "/v1", ImageDialect::kAuto), clock);
  EXPECT_EQ(generator->name(), "openai " + server.origin() + "/v1");
  const core::Image answer = generator->Generate(WordsRequest(384, 256));
  EXPECT_EQ(answer.width, 384);
  EXPECT_EQ(answer.height, 256);
  EXPECT_NEAR(answer.At(192, 128)[0], 128, 2);
  const nlohmann::json body =
      nlohmann::json::parse(server.SeenAt("/v1/images/generations").at(0).body);
  EXPECT_EQ(body.at("model"), "gpt-image-1");
  EXPECT_EQ(body.at("size"), "1536x1024");
  EXPECT_EQ(body.at("prompt"), "a red \"apple\" on white\nAvoid: hands");
  EXPECT_FALSE(body.contains("response_format"));
  const core::Findings findings = generator->TakeFindings();
  EXPECT_TRUE(HasFinding(findings, "image-seed-unused"));
  EXPECT_TRUE(HasFinding(findings, "image-resized"));
}

TEST(ImageEndpoints, OpenAiEditsInsideATransparentMask) {
  // 96 x 64 of the canvas 96 x 96, which the answer of 512 x 512 covers.
  core::Image picture = RampPicture(96, 96);
  ImageServer server([&](const httplib::Request& request, httplib::Response& response) {
    if (request.path == "/cdn/picture.png") {
      EXPECT_EQ(request.get_header_value("Authorization"), std::string("Bearer ") + kImageKey);
      response.set_content(core::EncodePng(picture), "image/png");
    } else {
      response.set_content(R"({"data": [{"url": "/cdn/picture.png"}]})", "application/json");
    }
  });
  llm::StillClock clock;
  ImageGeneratorOptions options = ImagesFrom(server.origin() + "/v1", ImageDialect::kOpenAi);
  options.model = "dall-e-2";
  const auto generator = MakeImageGenerator(options, clock);
  ImageRequest request = ViewRequest(96, 64);
  request.exemplar = RampPicture(20, 30);
  const core::Image answer = generator->Generate(request);
  ASSERT_EQ(answer.height, 64);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(answer.At(40, 10)[c], picture.At(40, 26)[c]);
  const SeenImageRequest seen = server.SeenAt("/v1/images/edits").at(0);
  EXPECT_EQ(seen.files.find("size")->second.content, "256x256");
  EXPECT_EQ(seen.files.find("response_format")->second.content, "b64_json");
  EXPECT_EQ(seen.files.count("image[]"), 2u);
  const core::Image mask = core::DecodeImage(seen.files.find("mask")->second.content, "mask");
  ASSERT_EQ(mask.channels, 4);
  ASSERT_EQ(mask.height, 96);
  EXPECT_EQ(mask.At(10, 48)[3], 255);  // kept
  EXPECT_EQ(mask.At(90, 48)[3], 0);    // repainted
  EXPECT_EQ(mask.At(90, 3)[3], 255);   // margin
  EXPECT_TRUE(HasFinding(generator->TakeFindings(), "image-depth-unused"));
}

TEST(ImageEndpoints, BadAnswersGiveOneClearLine) {
  std::string answer;
  int status = 200;
  ImageServer server([&](const httplib::Request&, httplib::Response& response) {
    response.status = status;
    response.set_content(answer, "application/json");
  });
  const ImageGeneratorOptions options = ImagesFrom(server.origin(), ImageDialect::kOpenAi);
  ImageGeneratorOptions web_ui = ImagesFrom(server.origin(), ImageDialect::kSdWebUi);
  const auto picture = [](const std::string& bytes) {
    return nlohmann::json{{"data", {{{"b64_json", core::Base64(bytes)}}}}}.dump();
  };
  answer = "<!DOCTYPE html><html>login</html>";
  ExpectPart("a web page (HTML), expected JSON", PictureFailure(options));
  ExpectPart("a web page (HTML), expected JSON", PictureFailure(web_ui));
  answer = "";
  ExpectPart("its answer is empty", PictureFailure(options));
  answer = "{\"data\": [{\"b64_json\": \"!!!!\"}]}";
  ExpectPart("is not Base64", PictureFailure(options));
  answer = R"({"data": [{"revised_prompt": "x"}]})";
  ExpectPart("neither a picture nor the address of one", PictureFailure(options));
  answer = picture("I cannot draw that.");
  ExpectPart("\"I cannot draw that.\", expected a picture", PictureFailure(options));
  answer = picture(core::EncodePng(RampPicture(64, 64)).substr(0, 60));
  ExpectPart("no usable picture", PictureFailure(options));
  answer = picture(core::EncodePng(core::Image(128, 96, 3, 0)));
  ExpectPart("one colour only", PictureFailure(options));
  answer = picture(core::EncodePng(RampPicture(128, 64)));
  ExpectPart("does not fit the view", PictureFailure(options, ViewRequest(96, 96)));
  ImageGeneratorOptions small = options;
  small.max_picture_pixels = 1000;
  EXPECT_NE(PictureFailure(small), "no failure");
  small.max_answer_bytes = 1000;
  answer = std::string(5000, 'x');
  ExpectPart("larger than", PictureFailure(small));
  answer = R"({"data": [{"url": "ftp://example.org/a.png"}]})";
  ExpectPart("no http or https address", PictureFailure(options));
  status = 400;
  answer = R"({"error": {"message": "Your request was rejected by the safety system.",
    "code": "moderation_blocked"}})";
  ExpectPart("content filter refuses the request: Your request was rejected",
             PictureFailure(options));
  status = 401;
  answer = std::string(R"({"error": {"message": "bad key )") + kImageKey + "\"}}";
  ExpectPart("SIMWRIGHT_IMAGE_KEY", PictureFailure(options));
  status = 422;
  answer = R"({"detail": [{"loc": ["body", "steps"], "msg": "value is not a valid integer"}]})";
  ExpectPart("status 422: value is not a valid integer", PictureFailure(web_ui));
}

TEST(ImageEndpoints, RetriesWhatMayPassAndNamesAServerThatIsDown) {
  int requests = 0;
  ImageServer server([&](const httplib::Request&, httplib::Response& response) {
    if (++requests < 3) {
      response.status = 503;
      response.set_header("Retry-After", "7");
      return;
    }
    response.set_content(nlohmann::json{{"images", {PngBase64(RampPicture(128, 96))}}}.dump(),
                         "application/json");
  });
  llm::StillClock clock;
  const auto generator =
      MakeImageGenerator(ImagesFrom(server.origin(), ImageDialect::kSdWebUi), clock);
  EXPECT_EQ(generator->Generate(WordsRequest()).width, 128);
  EXPECT_EQ(clock.sleeps, (std::vector<double>{7.0, 7.0}));

  ImageGeneratorOptions down = ImagesFrom("http://127.0.0.1:9", ImageDialect::kSdWebUi);
  ExpectPart("5 times in a row (is the server running and reachable?)", PictureFailure(down));
  down.dialect = ImageDialect::kAuto;
  ExpectPart("is the server running and reachable?", PictureFailure(down));
  requests = -1000;
  ImageServer strange([](const httplib::Request&, httplib::Response& response) {
    response.set_content("<html>router</html>", "text/html");
  });
  ExpectPart("speaks no known dialect",
             PictureFailure(ImagesFrom(strange.origin(), ImageDialect::kAuto)));
}

TEST(ImageEndpoints, KeysGoToTheirServerOnly) {
  const std::map<std::string, std::string> variables = {{"OPENAI_API_KEY", "openai-key"},
                                                        {"SIMWRIGHT_IMAGE_KEY", "image-key"}};
  const auto variable = [&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  };
  const auto only_openai = [&](const char* name) -> const char* {
    return std::string(name) == "OPENAI_API_KEY" ? "openai-key" : nullptr;
  };
  ImageGeneratorOptions options;
  options.url = "https://api.openai.com/v1";
  EXPECT_EQ(WithEnvironment(options, variable).key, "image-key");
  EXPECT_EQ(WithEnvironment(options, only_openai).key, "openai-key");
  options.url = "http://localhost:7860";
  EXPECT_EQ(WithEnvironment(options, only_openai).key, "");
  // A picture elsewhere is fetched without the key.
  ImageServer elsewhere([](const httplib::Request&, httplib::Response& response) {
    response.set_content(core::EncodePng(RampPicture(128, 96)), "image/png");
  });
  ImageServer server([&](const httplib::Request&, httplib::Response& response) {
    response.set_content(R"({"data": [{"url": ")" + elsewhere.origin() + R"(/p.png"}]})",
                         "application/json");
  });
  llm::StillClock clock;
  MakeImageGenerator(ImagesFrom(server.origin(), ImageDialect::kOpenAi), clock)
      ->Generate(WordsRequest());
  EXPECT_EQ(server.seen().at(0).authorization, std::string("Bearer ") + kImageKey);
  EXPECT_EQ(elsewhere.seen().at(0).authorization, "");
}

TEST(ImageEndpoints, KnowsTheAddressesOfThisMachine) {
  const auto is_here = [](const std::string& authority) {
    return llm::IsLoopback(llm::SplitUrl("http://" + authority + "/a.png").host);
  };
  for (const char* here :
       {"localhost", "LOCALHOST:80", "localhost.", "a.localhost", "127.0.0.1", "127.8.9.10:81",
        "127.1", "2130706433", "0x7f.1", "0.0.0.0", "0", "[::1]", "[0:0:0:0:0:0:0:1]:80", "[::]",
        "[::ffff:127.0.0.1]", "[::FFFF:7f00:1]", "[::ffff:0.0.0.0]"}) {
    EXPECT_TRUE(is_here(here)) << here;
  }
  for (const char* elsewhere :
       {"127.evil.com", "127.0.0.1.evil.com", "localhost.evil.com", "mylocalhost", "128.0.0.1",
        "0.0.0.1", "192.168.0.1", "[::2]", "[2001:db8::1]", "[::ffff:192.168.0.1]"}) {
    EXPECT_FALSE(is_here(elsewhere)) << elsewhere;
  }
}

TEST(ImageEndpoints, RefusesUnusableOptionsAndRequests) {
  ImageGeneratorOptions options = ImagesFrom("not a url", ImageDialect::kOpenAi);
  EXPECT_NE(PictureFailure(options), "no failure");
  options.url = "http://127.0.0.1:9";
  options.steps = 0;
  ExpectPart("steps", PictureFailure(options));
  options.steps = 20;
  options.key = "a b";
  ExpectPart("blank", PictureFailure(options));
  options.key.clear();
  ImageRequest request = WordsRequest();
  request.prompt.clear();
  ExpectPart("neither a prompt nor an exemplar", PictureFailure(options, request));
  request.exemplar = RampPicture(20, 20);
  ExpectPart("needs words", PictureFailure(options, request));
  options.workflow = "w.json";
  ExpectPart("a workflow is for ComfyUI", PictureFailure(options));
}

}  // namespace
}  // namespace simwright::texture
