#include "texture/endpoints/comfy_graph.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace simwright::texture {
namespace {

using core::OrderedJson;

OrderedJson Node(const char* type, OrderedJson inputs) {
  return {{"class_type", type}, {"inputs", std::move(inputs)}};
}

// Returns output `index` of the node `id`.
OrderedJson Output(const char* id, int index) {
  return OrderedJson::array({id, index});
}

std::vector<std::pair<std::string, OrderedJson>> Replacements(const ComfyValues& v) {
  return {{"prompt", v.prompt},
          {"negative_prompt", v.negative_prompt},
          {"seed", v.seed},
          {"width", v.width},
          {"height", v.height},
          {"steps", v.steps},
          {"guidance", v.guidance},
          {"denoising_strength", v.denoising_strength},
          {"checkpoint", v.checkpoint},
          {"render", v.render},
          {"mask", v.mask},
          {"depth", v.depth},
          {"exemplar", v.exemplar}};
}

// Replaces the placeholders of one text from left to right, so that replaced text is not read
// again.
OrderedJson FilledText(const std::string& text,
                       const std::vector<std::pair<std::string, OrderedJson>>& replacements) {
  std::string filled;
  for (std::size_t at = 0; at < text.size();) {
    const auto found = std::find_if(replacements.begin(), replacements.end(), [&](const auto& r) {
      return text.compare(at, r.first.size() + 2, "{" + r.first + "}") == 0;
    });
    if (found == replacements.end()) {
      filled += text[at++];
      continue;
    }
    const std::size_t length = found->first.size() + 2;
    if (length == text.size()) return found->second;
    filled += found->second.is_string()
                  ? found->second.get<std::string>()
                  : core::JsonLine(found->second, core::InvalidUtf8::kReplace);
    at += length;
  }
  return filled;
}

OrderedJson FilledValue(const OrderedJson& value,
                        const std::vector<std::pair<std::string, OrderedJson>>& replacements) {
  if (value.is_string()) return FilledText(value.get<std::string>(), replacements);
  OrderedJson filled = value;
  if (value.is_object()) {
    for (auto& [name, member] : filled.items()) member = FilledValue(member, replacements);
  } else if (value.is_array()) {
    for (OrderedJson& element : filled) element = FilledValue(element, replacements);
  }
  return filled;
}

// Adds the nodes of the latent picture and returns its output.
OrderedJson AddLatent(const ComfyValues& v, OrderedJson* graph) {
  if (v.render.empty()) {
    (*graph)["latent"] =
        Node("EmptyLatentImage", {{"width", v.width}, {"height", v.height}, {"batch_size", 1}});
    return Output("latent", 0);
  }
  (*graph)["render"] = Node("LoadImage", {{"image", v.render}});
  (*graph)["mask"] = Node("LoadImageMask", {{"image", v.mask}, {"channel", "red"}});
  (*graph)["encode"] =
      Node("VAEEncode", {{"pixels", Output("render", 0)}, {"vae", Output("checkpoint", 2)}});
  (*graph)["latent"] =
      Node("SetLatentNoiseMask", {{"samples", Output("encode", 0)}, {"mask", Output("mask", 0)}});
  return Output("latent", 0);
}

}  // namespace

OrderedJson ComfyGraph(const ComfyValues& v) {
  OrderedJson graph;
  graph["checkpoint"] = Node("CheckpointLoaderSimple", {{"ckpt_name", v.checkpoint}});
  graph["positive"] =
      Node("CLIPTextEncode", {{"text", v.prompt}, {"clip", Output("checkpoint", 1)}});
  graph["negative"] =
      Node("CLIPTextEncode", {{"text", v.negative_prompt}, {"clip", Output("checkpoint", 1)}});
  const OrderedJson latent = AddLatent(v, &graph);
  OrderedJson positive = Output("positive", 0), negative = Output("negative", 0);
  if (!v.depth.empty() && !v.depth_model.empty()) {
    graph["depth"] = Node("LoadImage", {{"image", v.depth}});
    graph["control_net"] = Node("ControlNetLoader", {{"control_net_name", v.depth_model}});
    graph["control"] = Node("ControlNetApplyAdvanced", {{"positive", positive},
                                                        {"negative", negative},
                                                        {"control_net", Output("control_net", 0)},
                                                        {"image", Output("depth", 0)},
                                                        {"strength", 1.0},
                                                        {"start_percent", 0.0},
                                                        {"end_percent", 1.0}});
    positive = Output("control", 0);
    negative = Output("control", 1);
  }
  graph["sampler"] = Node("KSampler", {{"model", Output("checkpoint", 0)},
                                       {"positive", positive},
                                       {"negative", negative},
                                       {"latent_image", latent},
                                       {"seed", v.seed},
                                       {"steps", v.steps},
                                       {"cfg", v.guidance},
                                       {"sampler_name", "dpmpp_2m"},
                                       {"scheduler", "karras"},
                                       {"denoise", v.render.empty() ? 1.0 : v.denoising_strength}});
  graph["decode"] =
      Node("VAEDecode", {{"samples", Output("sampler", 0)}, {"vae", Output("checkpoint", 2)}});
  graph["picture"] = Node("PreviewImage", {{"images", Output("decode", 0)}});
  return graph;
}

OrderedJson FilledWorkflow(const OrderedJson& workflow, const ComfyValues& values) {
  return FilledValue(workflow, Replacements(values));
}

bool HasPlaceholder(const OrderedJson& workflow, const std::string& name) {
  if (workflow.is_string()) {
    return workflow.get_ref<const std::string&>().find("{" + name + "}") != std::string::npos;
  }
  return workflow.is_structured() &&
         std::any_of(workflow.begin(), workflow.end(),
                     [&](const OrderedJson& member) { return HasPlaceholder(member, name); });
}

}  // namespace simwright::texture
