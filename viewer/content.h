#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/json.h"
#include "viewer/document.h"
#include "viewer/world_document.h"

namespace simwright::viewer {

// The content of a page: a document, and what is read or computed when the page asks for it. All
// members may be called from several threads.
class Content {
 public:
  explicit Content(Document document) : document_(std::move(document)) {}
  virtual ~Content() = default;
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;

  const Document& document() const { return document_; }
  int WorldCount() const { return static_cast<int>(document_.manifest["worlds"].size()); }

  // Returns the bodies of a world that the manifest lists without any. Requires
  // 0 <= world < WorldCount(). Throws core::Error if it cannot be read.
  virtual core::OrderedJson Bodies(int world);

  // Computes the motion of a world whose entry in the manifest has a `replay`: a drop, or an
  // episode. Throws core::Error if there is none, or it cannot be computed.
  virtual Timeline Replay(int world);

  // Returns the charts of a run as its log stands now, as an array.
  virtual core::OrderedJson Charts();

 private:
  Document document_;
};

// The source of the content.
struct ContentSource {
  // Reads the content. Throws core::Error.
  std::function<std::unique_ptr<Content>()> read;
  // Returns a text that changes with the files that `read` depends on; must not throw.
  std::function<std::string()> fingerprint;
};

// Returns the names, sizes and times of the files below `path` as one text, at most `most` of them;
// files for which `skipped` is true do not count. Links to folders are not followed.
std::string FingerprintOf(const std::string& path,
                          const std::function<bool(const std::string&)>& skipped = {},
                          int most = 20000);

}  // namespace simwright::viewer
