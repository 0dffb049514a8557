#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/finding.h"

namespace simwright::workflows {

// The form in which a photo is posted to a generator server.
enum class GeneratorFormat {
  kAuto,      // JSON, then multipart if the server refuses it with status 400, 415 or 422
  kJson,      // {"image": Base64 of the PNG}: Hunyuan3D's api_server.py
  kMultipart  // multipart/form-data with the PNG as a file: Stable Fast 3D, most FastAPI servers
};

// The user's own generator of meshes from photos: a server or a program, not both.
struct GeneratorOptions {
  std::string url;      // http(s)://host[:port]/path to post the photo to; empty: `command`
  std::string command;  // 'prog {in} {out}', split into arguments without a shell
  GeneratorFormat format = GeneratorFormat::kAuto;
  std::string field = "image";  // the name of the photo in the request
  // Further fields of the request: {"texture", "true"}. In JSON a value is a number, a Boolean or
  // an object if it reads as one, else a text.
  std::vector<std::pair<std::string, std::string>> parameters;
  std::string key;  // sent as a bearer token; empty: none
  // The address of a task's state, with {id} in place of the task's id. Empty: the one that the
  // server's answer names, else status/ID beside the address that the photo was posted to.
  std::string status_url;
  double timeout = 600.0;                       // s, for everything, retries included
  std::size_t max_answer_bytes = 512ull << 20;  // of a mesh
  char up = 0;  // the mesh's up axis: 'x', 'y', 'z', or 0: y in GLB, guessed in OBJ and PLY

  int max_attempts = 5;         // of a request
  double connect_timeout = 10;  // s
  double first_wait = 1.0;      // s before the second attempt; doubled each time, with jitter
  double longest_wait = 30.0;   // s
  double poll_wait = 2.0;       // s between two questions about a task
  std::uint64_t jitter_seed = 1;

  bool given() const { return !url.empty() || !command.empty(); }
};

// A mesh file from a generator.
struct GeneratedMesh {
  std::string bytes;
  std::string extension;  // ".glb", ".obj", ".ply" or ".zip", by its first bytes
  std::string generator;  // the server's scheme, host, port and path, or the program's name
  core::Findings findings;
};

}  // namespace simwright::workflows
