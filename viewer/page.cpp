#include "viewer/page.h"

#include <algorithm>

#include "core/base64.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text_template.h"
#include "viewer/web_data.h"

namespace simwright::viewer {
namespace {

using core::OrderedJson;

constexpr std::string_view kScript = "text/javascript; charset=utf-8";

// Returns JSON that can stand in a <script>: '<' is escaped, so that no text of it ends the script
// or begins a comment.
std::string ScriptJson(const OrderedJson& json) {
  std::string safe;
  for (const char c : core::JsonLine(json, core::InvalidUtf8::kReplace)) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

// Returns a module whose imports name other modules without a path, for the import map.
std::string BareImports(std::string_view text) {
  std::string bare(text);
  for (const std::string quote : {"\"", "'"}) {
    const std::string relative = quote + "./";
    for (const std::string keyword : {"from", "from ", "import ", "import(", "import"}) {
      const std::string pattern = keyword + relative;
      std::size_t at = 0;
      while ((at = bare.find(pattern, at)) != std::string::npos) {
        bare.erase(at + pattern.size() - 2, 2);
      }
    }
  }
  return bare;
}

std::string ImportMap() {
  OrderedJson imports = OrderedJson::object();
  for (const WebFile& file : WebFiles()) {
    if (file.type != kScript) continue;
    imports[std::string(file.name)] =
        "data:text/javascript;base64," + core::Base64(BareImports(file.text));
  }
  return ScriptJson({{"imports", imports}});
}

// Computes the replays of the first worlds; those of worlds without any are empty.
std::vector<Timeline> ReplaysOf(Content* content, int included, core::Progress* progress) {
  std::vector<Timeline> replays(static_cast<std::size_t>(included));
  progress->Stage("replays", included);
  core::ParallelFor(included, [&](int i) {
    const auto world = static_cast<std::size_t>(i);
    if (content->document().manifest["worlds"][world].contains("replay")) {
      replays[world] = content->Replay(i);
    }
    progress->Advance();
  });
  return replays;
}

// Fills in the bodies and replays of the first worlds, and removes the others.
void IncludeWorlds(Content* content, int most, core::Progress* progress, OrderedJson* manifest,
                   std::vector<Buffer>* buffers, core::Findings* findings) {
  OrderedJson worlds = OrderedJson::array();
  const int count = content->WorldCount();
  const int included = std::min(count, most);
  const std::vector<Timeline> replays = ReplaysOf(content, included, progress);
  for (int i = 0; i < included; ++i) {
    const Timeline& replay = replays[static_cast<std::size_t>(i)];
    OrderedJson world = (*manifest)["worlds"][static_cast<std::size_t>(i)];
    if (!world.contains("bodies")) world["bodies"] = content->Bodies(i);
    world.erase("replay");
    if (replay.frames() > 0) {
      OrderedJson json = TimelineJson(replay);
      json["buffer"] = buffers->size();
      buffers->push_back({TimelineBytes(replay), "application/octet-stream"});
      world["timelines"].push_back(std::move(json));
    }
    worlds.push_back(std::move(world));
  }
  (*manifest)["worlds"] = std::move(worlds);
  if (included < count) {
    findings->push_back({"view-worlds-left-out", core::Severity::kWarning, "",
                         "the file shows the first " + std::to_string(included) + " of " +
                             std::to_string(count) + " entries",
                         static_cast<double>(count - included),
                         "view the folder without --html, or raise --most"});
  }
}

}  // namespace

const std::vector<WebFile>& WebFiles() {
  static const std::vector<WebFile> files = {
      {"viewer.css", "text/css; charset=utf-8", data::viewer_css()},
      {"main.js", kScript, data::main_js()},
      {"source.js", kScript, data::source_js()},
      {"kinematics.js", kScript, data::kinematics_js()},
      {"meshes.js", kScript, data::meshes_js()},
      {"bodies.js", kScript, data::bodies_js()},
      {"glyphs.js", kScript, data::glyphs_js()},
      {"stage.js", kScript, data::stage_js()},
      {"orbit.js", kScript, data::orbit_js()},
      {"timeline.js", kScript, data::timeline_js()},
      {"charts.js", kScript, data::charts_js()},
      {"panel.js", kScript, data::panel_js()},
      {"elements.js", kScript, data::elements_js()},
      {"keys.js", kScript, data::keys_js()},
      {"inspection.js", kScript, data::inspection_js()},
      {"three.module.min.js", kScript, data::three_module_min_js()},
      {"three.core.min.js", kScript, data::three_core_min_js()}};
  return files;
}

std::string ServedPage() {
  return core::FillTemplate(
      data::page_html(),
      {{"policy", core::Markup{""}},
       {"style", core::Markup{"<link rel=\"stylesheet\" href=\"/viewer.css\"/>"}},
       {"content", core::Markup{""}},
       {"script", core::Markup{"<script type=\"module\" src=\"/main.js\"></script>"}}});
}

std::string SingleFilePage(Content* content, const SingleFileOptions& options,
                           core::Progress* progress, core::Findings* findings) {
  OrderedJson manifest = content->document().manifest;
  std::vector<Buffer> buffers = content->document().buffers;
  IncludeWorlds(content, options.worlds, progress, &manifest, &buffers, findings);
  std::string bytes;
  OrderedJson ranges = OrderedJson::array();
  for (const Buffer& buffer : buffers) {
    ranges.push_back(
        {{"begin", bytes.size()}, {"size", buffer.bytes.size()}, {"type", buffer.type}});
    bytes += buffer.bytes;
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    if (bytes.size() > options.largest) {
      throw core::Error("the content is larger than a page can hold: " +
                            std::to_string(bytes.size() >> 20) + " MiB",
                        "", "view it without --html, or lower --most");
    }
  }
  manifest["charts"] = content->Charts();
  manifest["buffers"] = std::move(ranges);
  manifest["live"] = false;
  const std::string text = ScriptJson(manifest);
  const std::string nonce = core::ContentHash(text + bytes);
  const std::string attribute = " nonce=\"" + nonce + "\"";
  return core::FillTemplate(
      data::page_html(),
      {{"policy",
        core::Markup{"<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
                     "script-src 'nonce-" +
                     nonce +
                     "'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
                     "form-action 'none'\"/>"}},
       {"style", core::Markup{"<style>\n" + std::string(data::viewer_css()) + "</style>"}},
       {"content", core::Markup{"<script type=\"application/json\" id=\"manifest\">" + text +
                                "</script>\n<script type=\"text/plain\" id=\"buffers\">" +
                                core::Base64(bytes) + "</script>"}},
       {"script", core::Markup{"<script type=\"importmap\"" + attribute + ">" + ImportMap() +
                               "</script>\n<script type=\"module\"" + attribute +
                               ">import \"main.js\";</script>"}}});
}

}  // namespace simwright::viewer
