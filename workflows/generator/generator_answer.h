#pragma once

#include <string>
#include <string_view>

namespace simwright::workflows {

// The content of a generator's answer.
struct GeneratorAnswer {
  enum class Kind {
    kMesh,     // `mesh` and `extension`
    kAddress,  // `address`, absolute or relative, of the mesh
    kTask,     // `task` and, if named, `address` of its state; or a task that is not complete
    kFailed,   // `message`: the server's reason
    kUnusable  // `message`: the content instead of a mesh
  };
  Kind kind = Kind::kUnusable;
  std::string mesh, extension, address, task, state, message;
};

// Reads an answer: the bytes of a mesh, or JSON with one of
// - a mesh as Base64, with or without "data:...;base64,", in any member, at most 4 levels deep
// - its address: a member called model_url, mesh_url, glb_url, download_url, file_url, response_url
// or
//   url, or any text that is an address and ends in .glb, .obj, .ply or .zip
// - a task: a member task_id, job_id, uid, request_id or id, or a member status or state of a task
//   that is not complete.
// A status failed, error or cancelled, or a member error, is a failure. Never throws, whatever
// `body` contains.
GeneratorAnswer ReadGeneratorAnswer(std::string body);

// Returns ".glb", ".obj", ".ply" or ".zip" by the first bytes of `bytes`, or "" for anything else.
std::string MeshExtensionOf(std::string_view bytes);

// Returns a description of bytes that are no mesh: "empty", "a web page (HTML)" or their beginning.
std::string DescribeContent(std::string_view bytes);

}  // namespace simwright::workflows
