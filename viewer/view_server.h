#pragma once

#include <memory>

#include "viewer/content.h"

namespace simwright::viewer {

// Serves a page with its content over HTTP on 127.0.0.1 alone. Answers GET only, of fixed paths:
// the page, its embedded files, the manifest, and buffers and worlds by version and number. No
// request names a file. Requests whose Host is not this computer are refused, so that no page of
// another site can read the content through a name that it controls.
class ViewServer {
 public:
  // Reads the content and binds the port; 0: a free one. Throws core::Error if the content cannot
  // be read, or another program has the port.
  // A connection is ended after `idle_seconds` without a request.
  ViewServer(ContentSource source, int port, int idle_seconds = 2);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  int port() const { return port_; }
  std::string url() const;
  const Content& first_content() const;

  // Answers requests until Ctrl-C (core::CancelRequested) or Stop.
  void Run();
  // Ends Run; may be called from another thread.
  void Stop();

 private:
  struct Server;
  std::unique_ptr<Server> server_;
  int port_ = 0;
};

}  // namespace simwright::viewer
