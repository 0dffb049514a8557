#include "viewer/contents/view.h"

#include <cstdio>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/json.h"
#include "viewer/contents/view_content.h"
#include "viewer/page.h"
#include "viewer/view_server.h"

namespace simwright::viewer {
namespace {

// Returns what the viewer itself has to say; the findings of assets are on the page.
core::Findings OwnFindings(const Content& content) {
  const core::OrderedJson& all = content.document().manifest["findings"];
  if (!all.is_array()) return {};
  const core::JsonDocument document(core::JsonText(all), "the page", "");
  core::Findings own = core::FindingsFrom(document.root());
  std::erase_if(own, [](const auto& finding) { return !finding.code.starts_with("view-"); });
  return own;
}

}  // namespace

ViewReport WriteView(const ViewRequest& request, core::Progress* progress) {
  if (std::filesystem::exists(request.html) && !request.force) {
    throw core::Error("the file exists", request.html.string(), "use --force to replace it");
  }
  const std::filesystem::path folder = request.html.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw core::Error("no such folder", folder.string(), "create it");
  }
  progress->Stage("read");
  const std::unique_ptr<Content> content = ReadViewContent(request.path);
  ViewReport report;
  report.file = request.html;
  const core::OrderedJson& manifest = content->document().manifest;
  report.kind = manifest["kind"].get<std::string>();
  report.findings = OwnFindings(*content);
  SingleFileOptions options;
  options.worlds = request.most;
  const std::string page = SingleFilePage(content.get(), options, progress, &report.findings);
  core::WriteFile(request.html, page);
  report.entries = std::min(request.most, content->WorldCount());
  report.megabytes = static_cast<double>(page.size()) * 1e-6;
  return report;
}

void ServeView(const ViewRequest& request,
               const std::function<void(const std::string& url, const core::Findings&)>& started) {
  ViewServer server(ViewSource(request.path), request.port);
  started(server.url(), OwnFindings(server.first_content()));
  server.Run();
}

std::string ViewTable(const ViewReport& report) {
  char line[64];
  std::snprintf(line, sizeof line, "  %.1f MB, %d %s\n", report.megabytes, report.entries,
                report.entries == 1 ? "entry" : "entries");
  return "wrote " + report.file.string() + line;
}

std::string ViewJson(const ViewReport& report) {
  return core::JsonText(core::OrderedJson{{"file", report.file.string()},
                                          {"kind", report.kind},
                                          {"entries", report.entries},
                                          {"megabytes", report.megabytes}});
}

}  // namespace simwright::viewer
