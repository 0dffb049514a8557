#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "viewer/content.h"

namespace simwright::viewer {

// A file of the page, embedded in the program.
struct WebFile {
  std::string_view name;  // "main.js"
  std::string_view type;  // media type
  std::string_view text;
};

// Returns the style sheet and the scripts, those of three.js included.
const std::vector<WebFile>& WebFiles();

// Returns the page as it is served: its scripts are loaded from the server, which also answers its
// requests for the content.
std::string ServedPage();

struct SingleFileOptions {
  int worlds = 60;                     // at most so many are included, with their replays
  std::size_t largest = 400ull << 20;  // bytes of buffers; more is an error
};

// Returns the whole content as one file that needs no server and no network. Scripts and buffers
// are inlined, and a policy in the page forbids all others. Replays are computed first, in
// parallel; `progress` counts them. Reports in `findings` what was left out. Throws core::Error if
// the content is larger than `options.largest`, or cannot be read.
std::string SingleFilePage(Content* content, const SingleFileOptions& options,
                           core::Progress* progress, core::Findings* findings);

}  // namespace simwright::viewer
