#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/finding.h"
#include "core/progress.h"

namespace simwright::viewer {

struct ViewRequest {
  // An asset folder, a URDF, a mesh, a folder of assets, a dataset of scenes, an exported scene, a
  // JSON file of poses, a tasks.json, the poses of a rollout, a training, or a photo run.
  std::filesystem::path path;
  int port = 0;                // 0: a free one
  std::filesystem::path html;  // writes one file instead of serving; empty: serves
  int most = 60;               // entries (scenes, tasks, assets) in that file
  bool force = false;          // replaces that file
};

// The page that was written.
struct ViewReport {
  std::filesystem::path file;
  std::string kind;  // of the content: "asset", "scenes" ...
  int entries = 0;
  double megabytes = 0.0;
  core::Findings findings;
};

// Writes the page of request.html. Throws core::Error for a file that exists or has no folder, for
// a path that cannot be shown, and for content that is damaged or too large.
ViewReport WriteView(const ViewRequest& request, core::Progress* progress);

// Serves the page until Ctrl-C; calls `started` with its address and the viewer's findings. The
// content is read again when files below the path have changed. Throws core::Error as WriteView
// does, and for a port that is not free.
void ServeView(const ViewRequest& request,
               const std::function<void(const std::string& url, const core::Findings&)>& started);

std::string ViewTable(const ViewReport& report);
std::string ViewJson(const ViewReport& report);

}  // namespace simwright::viewer
