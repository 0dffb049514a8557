#pragma once

#include <string>
#include <vector>

namespace simwright::texture {

// A field of a form; a file if `file_name` is not empty.
struct FormField {
  std::string name, content;
  std::string file_name = {}, content_type = {};
};

// The body of a request as multipart/form-data (RFC 7578).
struct MultipartForm {
  std::string content_type;  // with the boundary, which occurs in no field
  std::string body;
};
MultipartForm MakeMultipartForm(const std::vector<FormField>& fields);

}  // namespace simwright::texture
